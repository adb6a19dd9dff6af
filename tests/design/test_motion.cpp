// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The candidate motions of a design.
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <variant>
#include <vector>

#include "catch.hpp"
#include "design/limits.hpp"
#include "design/merit.hpp"
#include "design/motion.hpp"
#include "design/multisine.hpp"

namespace bbsim_test::test_motion {

using namespace bbsim;
using design::Motion;
using design::Plays;

namespace {

constexpr double length = 6;  // s

Motion drawn(Plays plays, std::array<bool, 2> axes = {true, true}) {
  Noise noise(3);
  const design::Multisine shape({plays, length, 18, 3, axes}, noise);
  std::vector<double> numbers;
  for (std::size_t i = 0; i < shape.size(); ++i) numbers.push_back(noise.normal());
  return shape.motion(numbers);
}

double amplitudes(const Motion& motion, std::size_t axis) {
  double sum = 0;
  for (const Sinusoid& sine : motion.sines[axis]) sum += std::abs(sine.amplitude);
  return sum;
}

}  // namespace

TEST_CASE("a sum of sines begins and ends at rest and leaves the ball at rest") {
  const Plays plays = GENERATE(Plays::tilts, Plays::reference);
  const Motion motion = drawn(plays);
  for (const std::size_t axis : {0U, 1U}) {
    REQUIRE(motion.sines[axis].size() == 4);
    const double size = amplitudes(motion, axis);
    REQUIRE(size > 0);
    double rate = 0, kick = 0;
    for (const Sinusoid& sine : motion.sines[axis]) {
      // Whole number of periods.
      const double periods = sine.frequency * length / 6.283185307179586;
      CHECK(periods == Approx(std::round(periods)));
      rate += sine.frequency * sine.amplitude * std::cos(sine.phase);
      // The mean velocity of x'' = tilt, from rest.
      kick += sine.amplitude * std::cos(sine.phase) / sine.frequency;
    }
    // A few rounding errors of the largest term.
    CHECK(std::abs(motion.value(axis, 0)) < 1e-13 * size);
    CHECK(std::abs(motion.value(axis, length)) < 1e-12 * size);
    CHECK(std::abs(rate) < 1e-12 * size);
    if (plays == Plays::tilts) CHECK(std::abs(kick) < 1e-13 * size);
  }
}

TEST_CASE("only one axis of a groove is free") {
  const Motion motion = drawn(Plays::tilts, {false, true});
  CHECK(motion.sines[0].empty());
  CHECK(motion.sines[1].size() == 4);
  CHECK(motion.value(0, 1) == 0);
}

TEST_CASE("scaling a motion scales the ball's start") {
  Motion motion = drawn(Plays::tilts);
  motion.step = {0.1, 0};
  motion.step_start = 1;
  motion.position = {0.03, -0.01};
  motion.velocity = {0, 0.2};
  const Motion half = motion.scaled(0.5);
  for (const double t : {0.3, 1.04, 2.0}) {
    for (const std::size_t axis : {0U, 1U}) {
      CHECK(half.value(axis, t) == Approx(0.5 * motion.value(axis, t)));
    }
  }
  CHECK(half.position == Pair{0.015, -0.005});
  CHECK(half.velocity == Pair{0, 0.1});
}

TEST_CASE("a step rises smoothly to its value") {
  Motion motion;
  motion.step = {2, -1};
  motion.step_start = 1;
  CHECK(motion.value(0, 1) == 0);
  CHECK(motion.value(0, 1 + design::rise_time / 2) == Approx(1));
  CHECK(motion.value(0, 1 + design::rise_time) == Approx(2));
  CHECK(motion.value(1, 5) == -1);
}

TEST_CASE("a motion is played with the scenario's changes to its tables") {
  const design::Placeholder rows = design::placeholder(length);
  const double scale = 1.2, offset = 0.02, delay = 0.1;
  const auto changed = [&](double by_scale, double by_offset, double by_delay) {
    Scenario scenario;
    scenario.gimbal.motion.emplace();
    for (Profile* const profile : {&scenario.gimbal.motion->phi, &scenario.gimbal.motion->theta}) {
      Table table;
      for (std::size_t i = 0; i < rows.times.size(); ++i) {
        table.times.push_back(rows.times[i] + by_delay);
        table.values.push_back(by_offset + by_scale * rows.values[i]);
      }
      profile->emplace_back(table);
    }
    return scenario;
  };
  const Motion motion = drawn(Plays::tilts);
  const auto nominal = design::changes_of(changed(scale, offset, delay));
  CHECK(nominal[0].scale == Approx(scale));
  CHECK(nominal[0].offset == Approx(offset));
  CHECK(nominal[0].delay == Approx(delay));

  const auto value = [](const Profile& profile, double t) {
    double sum = 0;
    for (const ProfileTerm& term : profile) {
      if (const auto* const constant = std::get_if<double>(&term)) sum += *constant;
      const auto* const sine = std::get_if<Sinusoid>(&term);
      if (sine != nullptr) sum += sine->amplitude * std::sin(sine->frequency * t + sine->phase);
    }
    return sum;
  };
  // Once with the nominal changes, once as a table would play with others.
  for (const double other : {scale, 1.5}) {
    Scenario scenario = changed(other, offset, delay);
    design::play(motion, Plays::tilts, nominal, length, scenario);
    for (const double t : {0.2, 1.7, 4.0}) {
      const double command = design::command(motion, 0, nominal[0], t - delay);
      CHECK(value(scenario.gimbal.motion->phi, t) == Approx(offset + other * command));
    }
  }
}

TEST_CASE("a motion's use of the limits") {
  design::Limits limits;
  limits.rectangle = Pair{0.1, 0.2};
  limits.tilt = {0.2, 0.1};
  limits.tilt_rate = {1, 2};
  limits.total_tilt = 0.25;
  // Two rows of x, y, phi, theta, their rates, and the tilt.
  const design::Use use =
      design::use_of(limits, {0.05, -0.08, 0, 0.1, 0.1, 0, -0.05, 0, 0.3, 0, 0, -1, 0.15, 0.02});
  CHECK(use.edge[0] == Approx(0.5));
  CHECK(use.edge[1] == Approx(0.8));
  CHECK(use.edge[2] == Approx(0.5));
  CHECK(use.edge[3] == 0);
  CHECK(use.tilt[0] == Approx(0.5));
  CHECK(use.tilt[1] == Approx(0.5));
  CHECK(use.total_tilt == Approx(0.6));
  CHECK(use.tilt_rate[0] == Approx(0.3));
  CHECK(use.tilt_rate[1] == Approx(0.5));
  CHECK(use.middle[0] == Approx(-0.015));
  CHECK(use.greatest() == Approx(0.8));
  CHECK(use.greatest_edge() == Approx(0.8));
  limits.rectangle.reset();
  limits.disc = 0.1;
  limits.total_tilt.reset();
  CHECK(design::use_of(limits, {0.06, 0, 0.08, 0, 0, 0, 0, 0, 0, 0, 0, 0}).greatest() == Approx(1));
}

TEST_CASE("deviations come from the inverse, and are infinite for keys that cannot be found") {
  Eigen::MatrixXd information(2, 2);
  information << 4, 1, 1, 2;
  const std::vector<double> both = design::deviations_of(information);
  CHECK(both[0] == Approx(std::sqrt(2.0 / 7)));
  CHECK(both[1] == Approx(std::sqrt(4.0 / 7)));
  CHECK(design::merit_of(information) == Approx(std::log(7)));
  // The first two keys enter only as a sum, whatever their scales.
  Eigen::MatrixXd torn = Eigen::MatrixXd::Zero(3, 3);
  torn.topLeftCorner(2, 2) << 1, 1e3, 1e3, 1e6;
  torn(2, 2) = 4;
  const std::vector<double> three = design::deviations_of(torn);
  CHECK(std::isinf(three[0]));
  CHECK(std::isinf(three[1]));
  CHECK(three[2] == Approx(0.5));
  CHECK(std::isfinite(design::merit_of(torn)));
}

}  // namespace bbsim_test::test_motion
