// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Thinning a long run loses no peak in a plot and no turn in the motion.
#include <algorithm>
#include <cmath>

#include "catch.hpp"
#include "circling.hpp"
#include "replay/kept.hpp"
#include "replay/scene.hpp"

namespace bbsim_test::test_kept_rows {

using bbsim::product;
using bbsim::Quaternion;
using namespace bbsim::replay;
using bbsim_test::circling;

namespace {

// Largest deviation of a column from linear interpolation between the kept rows.
double worst_error(const Run& run, const char* name, const std::vector<std::size_t>& kept) {
  const auto& t = run.find("t")->numbers;
  const auto& v = run.find(name)->numbers;
  double worst = 0;
  for (std::size_t k = 1; k < kept.size(); ++k) {
    const std::size_t a = kept[k - 1], b = kept[k];
    for (std::size_t i = a; i <= b; ++i) {
      const double line = v[a] + (v[b] - v[a]) * (t[i] - t[a]) / (t[b] - t[a]);
      worst = std::max(worst, std::abs(line - v[i]));
    }
  }
  return worst;
}

}  // namespace

TEST_CASE("a short run keeps all its rows") {
  const Run run = circling(1000);
  const KeptRows kept = kept_rows(run, {}, 1000);
  REQUIRE(kept.rows.size() == 1000);
  CHECK(kept.rows.front() == 0);
  CHECK(kept.rows.back() == 999);
  CHECK(kept.buckets == 0);
  CHECK(kept.motion_error == 0);
}

TEST_CASE("the motion between kept rows is within its tolerances") {
  const Run run = circling(100'000);
  const auto orientation = orientation_of(run, 0.01);
  const KeptRows kept = kept_rows(run, orientation, 20'000);
  CHECK(kept.rows.size() <= 20'000);
  CHECK(std::is_sorted(kept.rows.begin(), kept.rows.end()));
  CHECK(kept.rows.front() == 0);
  CHECK(kept.rows.back() == 99'999);
  CHECK(kept.motion_error <= 1);
  CHECK(worst_error(run, "x", kept.rows) <= 0.05 * position_tolerance * (1 + 1e-9));
  CHECK(worst_error(run, "y", kept.rows) <= 0.05 * position_tolerance * (1 + 1e-9));
  CHECK(worst_error(run, "phi", kept.rows) <= angle_tolerance * (1 + 1e-9));
  // Between kept rows the ball turns little enough for the direction to be unambiguous.
  for (std::size_t k = 1; k < kept.rows.size(); ++k) {
    double turned = 0;
    for (std::size_t i = kept.rows[k - 1] + 1; i <= kept.rows[k]; ++i) {
      const Quaternion& before = orientation[i - 1];
      const Quaternion step =
          product(orientation[i], {before[0], -before[1], -before[2], -before[3]});
      turned += 2 * std::acos(std::min(1.0, std::abs(step[0])));
    }
    CHECK(turned <= 2.1);
  }
}

TEST_CASE("each stretch keeps every column's least and greatest value") {
  Run run = circling(50'000);
  std::vector<double> noise(50'000);
  for (std::size_t i = 0; i < noise.size(); ++i) {
    noise[i] = std::sin(static_cast<double>(i * i % 1009));
  }
  run.columns.push_back({"noise", noise, {}, "1"});
  const KeptRows kept = kept_rows(run, {}, 4000);
  REQUIRE(kept.buckets > 100);
  CHECK(kept.rows.size() <= 4000);
  for (std::size_t b = 0; b < kept.buckets; ++b) {
    const auto begin = static_cast<std::ptrdiff_t>(50'000 * b / kept.buckets);
    const auto end = static_cast<std::ptrdiff_t>(50'000 * (b + 1) / kept.buckets);
    const auto [low, high] = std::minmax_element(noise.begin() + begin, noise.begin() + end);
    double kept_low = 1e9, kept_high = -1e9;
    for (const std::size_t row : kept.rows) {
      if (static_cast<std::ptrdiff_t>(row) < begin || static_cast<std::ptrdiff_t>(row) >= end) {
        continue;
      }
      kept_low = std::min(kept_low, noise[row]);
      kept_high = std::max(kept_high, noise[row]);
    }
    CHECK(kept_low == *low);
    CHECK(kept_high == *high);
  }
}

TEST_CASE("rows of NaN do not prevent the choice of rows") {
  Run run = circling(30'000);
  for (std::size_t i = 10'000; i < 12'000; ++i) run.columns[1].numbers[i] = std::nan("");
  run.columns[2].numbers[20'000] = INFINITY;
  const KeptRows kept = kept_rows(run, orientation_of(run, 0.01), 5000);
  CHECK(kept.rows.size() <= 5000);
  CHECK(kept.rows.back() == 29'999);
}

TEST_CASE("if space is short the worst errors are fixed first, and the rest is reported") {
  const Run run = circling(100'000);
  const auto orientation = orientation_of(run, 1e-5);  // turns 3 rad from row to row
  const KeptRows kept = kept_rows(run, orientation, 500);
  CHECK(kept.rows.size() <= 500);
  CHECK(kept.motion_error > 1);
}

TEST_CASE("a large grid is thinned to a grid, and other sweeps evenly") {
  Sweep sweep;
  for (int i = 0; i < 100; ++i) {
    for (int k = 0; k < 50; ++k) {
      sweep.cases.push_back(50 * i + k);
      sweep.status.emplace_back("done");
    }
  }
  sweep.keys = {{{"a", {}}}, {{"b", {}}}};
  for (int i = 0; i < 5000; ++i) {
    sweep.keys[0].numbers.push_back(i / 50);
    sweep.keys[1].numbers.push_back(i % 50);
  }
  CHECK(cases_kept(sweep, 5000).size() == 5000);
  const auto grid = cases_kept(sweep, 2000);
  CHECK(grid.size() == 1250);  // every 4th value of the key with 100 values, all of the other's
  for (const std::size_t i : grid) CHECK(i / 50 % 4 == 0);
  sweep.keys[0].numbers[7] = 0.123;  // no longer a grid
  const auto others = cases_kept(sweep, 2000);
  CHECK(others.size() == 1667);
  CHECK(others[1] == 3);
}

}  // namespace bbsim_test::test_kept_rows
