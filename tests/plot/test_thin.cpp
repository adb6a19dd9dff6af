// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cmath>

#include "catch.hpp"
#include "plot/thin.hpp"

namespace bbsim_test::test_thin {

using namespace bbsim::plot;

namespace {

Panel panel_to(double x_high, double y_low, double y_high) {
  Panel panel;
  panel.box = {0, 0, 500, 100};
  panel.x = {0, x_high};
  panel.y = {y_low, y_high};
  return panel;
}

}  // namespace

TEST_CASE("no spike and no gap is lost, for any number of rows") {
  constexpr std::size_t rows = 1000000;
  Curve curve;
  for (std::size_t i = 0; i < rows; ++i) {
    curve.x.push_back(static_cast<double>(i));
    curve.y.push_back(std::sin(static_cast<double>(i) * 1e-4));
  }
  curve.y[123457] = 7;
  curve.y[765431] = -5;
  curve.y[555555] = NAN;
  const Curve thin = thin_over_time(curve, panel_to(rows, -5, 7));
  CHECK(thin.x.size() <= 5 * 500);
  CHECK(thin.x.front() == 0);
  CHECK(thin.x.back() == rows - 1);
  CHECK(std::ranges::max(thin.y, [](double a, double b) { return a < b; }) == 7);
  CHECK(std::ranges::count(thin.y, -5) == 1);
  CHECK(std::ranges::count_if(thin.y, [](double y) { return std::isnan(y); }) == 1);
  CHECK(std::ranges::is_sorted(thin.x));
}

TEST_CASE("few rows, and times that go backward, stay unchanged") {
  Curve few;
  few.x = {0, 1, 2};
  few.y = {3, 4, 5};
  CHECK(thin_over_time(few, panel_to(2, 3, 5)).y == few.y);
  Curve back;
  for (int i = 0; i < 10000; ++i) {
    back.x.push_back(i % 100);
    back.y.push_back(i);
  }
  CHECK(thin_over_time(back, panel_to(100, 0, 10000)).x.size() == back.x.size());
}

TEST_CASE("a path keeps its ends, and its shape to a fraction of a pixel") {
  Curve path;
  constexpr int rows = 200000;
  for (int i = 0; i < rows; ++i) {
    const double angle = 1e-4 * i;
    path.x.push_back(50 + 40 * std::cos(angle));
    path.y.push_back(50 + 40 * std::sin(angle));
  }
  const Panel panel = panel_to(100, 0, 100);
  const Curve thin = thin_path(path, panel);
  CHECK(thin.x.size() < 50000);
  CHECK(thin.x.size() > 100);
  CHECK(thin.x.front() == path.x.front());
  CHECK(thin.x.back() == path.x.back());
}

TEST_CASE("a path of mostly gaps is thinned in finite time") {
  Curve path;
  for (int i = 0; i < 200000; ++i) {
    path.x.push_back(i % 2 == 0 ? NAN : 50);
    path.y.push_back(i % 100);
  }
  CHECK(thin_path(path, panel_to(100, 0, 100)).x.size() <= path.x.size());
}

}  // namespace bbsim_test::test_thin
