// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Measures of a run, also at the ends of the range of doubles.
#include <cmath>
#include <limits>
#include <vector>

#include "catch.hpp"
#include "record/instants.hpp"
#include "record/recorder.hpp"
#include "scenario/reader.hpp"
#include "support/measured.hpp"

namespace bbsim_test::test_recorder {

using namespace bbsim;
using namespace bbsim::record;
using bbsim_test::MeasuredRun;
using namespace bbsim::scenario;

namespace {

double root_mean_square(const std::vector<double>& values) {
  SquareSum sum;
  for (const double value : values) sum.add(value);
  return sum.root_mean(values.size());
}

MeasuredRun run(const std::string& text, const std::vector<std::string>& names) {
  const Scenario scene = parse_scenario(text, "scene.yaml");
  return measured(scene, measures_named(names, scene), Method::automatic, {1e-8, 1e-10});
}

}  // namespace

TEST_CASE("the root mean square neither overflows nor underflows") {
  for (const double size : {1e-300, 1e-234, 1e-150, 1.0, 1e150, 1e234, 1e300}) {
    CAPTURE(size);
    // One rounding error each for root, division and scaling.
    CHECK(root_mean_square({3 * size, -4 * size}) == Approx(size * std::sqrt(12.5)).epsilon(1e-15));
    CHECK(root_mean_square({size, 0, 0, 0}) == Approx(size / 2).epsilon(1e-15));
  }
  CHECK(root_mean_square({0, 0}) == 0);
  // Much smaller values add nothing, and values near the limits are kept.
  CHECK(root_mean_square({1e200, 1}) == Approx(1e200 / std::sqrt(2)).epsilon(1e-15));
  CHECK(root_mean_square({0.9e-140, 1.1e-140}) == Approx(std::sqrt(1.01) * 1e-140).epsilon(1e-14));
  CHECK(root_mean_square({0.9e140, 1.1e140}) == Approx(std::sqrt(1.01) * 1e140).epsilon(1e-14));
  // Elsewhere, bit for bit the plain formula.
  const double a = 0.1, b = 0.7;
  CHECK(root_mean_square({a, b}) == std::sqrt((a * a + b * b) / 2));
  CHECK(std::isinf(root_mean_square({std::numeric_limits<double>::infinity(), 1})));
}

TEST_CASE("rms_ of a motion of 1e234 m is finite") {
  const MeasuredRun made =
      run("gravity: 0\nball: {radius: 0.01, position: [1e234, 0]}\n"
          "gimbal: {motion: {}}\ntime: {end: 1, step: 0.5}\n",
          {"rms_x"});
  CHECK(made.values[0] == Approx(1e234).epsilon(1e-15));
}

TEST_CASE("a nonfinite measure has its reason") {
  const std::vector<Measure> measures{*find_measure("end_x"), *find_measure("max_motor_power"),
                                      *find_measure("max_energy")};
  const double nan = std::nan(""), infinite = std::numeric_limits<double>::infinity();
  const double finite[] = {1, 2, 3}, bad[] = {1, nan, infinite};
  const Whys whys{nullptr, "plate.inertia is not known", nullptr};
  CHECK(why_not_finite(measures, finite, whys).empty());
  CHECK(why_not_finite(measures, bad, whys) ==
        "max_motor_power is not a number: plate.inertia is not known; max_energy is infinite");
  CHECK(why_not_finite(measures, bad, {}) ==
        "max_motor_power is not a number; max_energy is infinite");
}

TEST_CASE("a recorder knows why a measure has no value") {
  const MeasuredRun made =
      run("ball: {radius: 0.01}\ngimbal: {motion: {}}\ntime: {end: 1, step: 0.5}\n",
          {"x.Overshoot", "when x=1", "rms_x from 0.6 s to 0.9 s", "max_x", "when x stays above 0",
           "find x at 3"});
  CHECK(made.why ==
        "x.Overshoot is not a number: it should end where it starts, so its step is 0; "
        "when x=1 cross=1 is not a number: it does not happen; "
        "rms_x from 0.6 s to 0.9 s is not a number: no row is within its window; "
        "when x stays above 0 is not a number: it does not stay there; "
        "find x at 3 is not a number: the time is outside the measured part");
}

}  // namespace bbsim_test::test_recorder
