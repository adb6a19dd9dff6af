// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <cstdio>
#include <set>
#include <string>
#include <vector>

#include "catch.hpp"
#include "plot/axis.hpp"
#include "plot/text.hpp"

namespace bbsim_test::test_axis {

using namespace bbsim::plot;

namespace {

Range range_of(double low, double high) {
  Range range;
  range.include(low);
  range.include(high);
  return range;
}

std::vector<double> tics_of(const Axis& axis) {
  std::vector<double> tics;
  const double first = std::ceil(axis.low / axis.step), last = std::floor(axis.high / axis.step);
  for (double i = first; i <= last; ++i) tics.push_back(i * axis.step);
  return tics;
}

// The labels as gnuplot writes them with the given format.
std::set<std::string> labels_of(const Axis& axis) {
  std::set<std::string> labels;
  for (const double tic : tics_of(axis)) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", axis.decimals(), tic);
    labels.insert(text);
  }
  return labels;
}

}  // namespace

TEST_CASE("labels are short and distinct for values of any size") {
  for (const char* unit : {"m", "s", "N m", "m/s", "", "rad"}) {
    for (int exponent = -274; exponent <= 300; exponent += 7) {
      for (const double part : {0.0, 1e-12, 1e-7, 1e-5, 3e-3, 0.4, 2.0}) {
        const double size = std::pow(10.0, exponent);
        const Range range = range_of(size * (1 - part / 2), size * (1 + part / 2));
        const Scale scale = choose_scale({unit}, range);
        const Axis axis = linear_axis(scale(range), Along::y, 100);
        CAPTURE(unit, exponent, part, scale.unit, scale.offset, axis.low, axis.high);
        REQUIRE(axis.low < axis.high);
        CHECK(axis.low <= scale(range.low));
        CHECK(axis.high >= scale(range.high));
        const std::set<std::string> labels = labels_of(axis);
        CHECK(labels.size() >= 2);
        CHECK(labels.size() <= 10);
        // The space of a panel's margin; all labels differ.
        for (const std::string& label : labels) CHECK(width_of(label, 13) <= 58);
        CHECK(labels.size() == tics_of(axis).size());
      }
    }
  }
}

TEST_CASE("units fit the values") {
  const auto unit = [](const char* base, double largest) {
    return choose_scale({base}, range_of(-largest, largest)).unit;
  };
  CHECK(unit("m", 0.05) == "cm");
  CHECK(unit("m", 0.005) == "mm");
  CHECK(unit("m", 3e-6) == "µm");
  CHECK(unit("m", 86) == "m");
  CHECK(unit("m", 52000) == "km");
  CHECK(unit("m", 1e300) == "10²⁹⁷ km");
  CHECK(unit("m", 0) == "cm");
  CHECK(unit("s", 40) == "s");
  CHECK(unit("s", 1e-9) == "ns");
  CHECK(unit("s", 1e6) == "10⁶ s");
  CHECK(unit("N m", 0.11) == "mN m");
  CHECK(unit("rad", 1.4e6) == "10⁶ rad");
  CHECK(unit("", 0.006) == "10⁻³");
}

TEST_CASE("values that differ little are drawn as differences from a round value") {
  const Scale scale = choose_scale({"m"}, range_of(-0.1, -0.1 + 1e-9));
  CHECK(scale.heading("y") == "y + 0.1 m (nm)");
  CHECK(scale(-0.1 + 1e-9) == Approx(1).margin(1e-6));
  CHECK(choose_scale({"m"}, range_of(-0.1, -0.1 + 1e-9), 0).shift.empty());
  // Values that differ only by rounding count as constant.
  CHECK(choose_scale({"m"}, range_of(0.1, std::nextafter(0.1, 1))).shift.empty());
}

TEST_CASE("the two axes of a plane have one factor") {
  const PlaneScales scales = choose_scales({"m"}, range_of(0, 1e-9), range_of(-0.1, -0.1));
  CHECK(scales.x.factor == scales.y.factor);
  CHECK(scales.x.heading("x") == "x (nm)");
  CHECK(scales.y.heading("y") == "y + 0.1 m (nm)");
}

TEST_CASE("constant and missing values still have an axis") {
  const Axis constant = linear_axis({5, 5}, Along::y, 100);
  CHECK(constant.low < 5);
  CHECK(constant.high > 5);
  const Axis zero = linear_axis({0, 0}, Along::y, 100);
  CHECK(zero.low < 0);
  const Axis none = linear_axis({}, Along::y, 100);
  CHECK(none.low < none.high);
}

TEST_CASE("logarithmic axes have tics over any number of decades") {
  for (const double high : {2.0, 12.0, 1e2, 1e5, 1e30, 1e300}) {
    const Axis axis = log_axis({1, high}, Along::x, 300, 0.02);
    CAPTURE(high);
    CHECK(axis.tics.size() >= 2);
    CHECK(axis.tics.size() <= 9);
    CHECK(axis.fraction(1) >= 0);
    CHECK(axis.fraction(high) <= 1);
  }
  CHECK(log_axis({1e-8, 1e8}, Along::x, 300, 0).tics.front().label == "10⁻⁸");
  CHECK(better_by_log({1e-4, 1}));
  CHECK_FALSE(better_by_log({0, 1}));
  CHECK_FALSE(better_by_log({-1, 1e9}));
}

TEST_CASE("labels below a panel keep a letter's distance, however long they are") {
  for (const double pixels : {120.0, 300.0, 480.0}) {
    const Axis axis = linear_axis({64.00465, 64.02571}, Along::x, pixels, 0);
    const std::set<std::string> labels = labels_of(axis);
    REQUIRE(labels.size() >= 2);
    const double apart = axis.step / (axis.high - axis.low) * pixels;
    for (const std::string& label : labels) CHECK(apart > width_of(label, 13) + 8);
  }
}

}  // namespace bbsim_test::test_axis
