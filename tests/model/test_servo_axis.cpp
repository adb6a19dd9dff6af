// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Crossings of a servo's guards under a held command, and its clearance from them; its modes are in
// tests/solve/test_servo.cpp.
#include <vector>

#include "catch.hpp"
#include "model/servo/servo_axis.hpp"

namespace bbsim_test::test_servo_axis {

using namespace bbsim::model;
using bbsim::unlimited;

namespace {

// A second-order servo with stiffness 100 / s^2, damping 10 / s and these limits.
const ServoResponse response{100, 100, 10};

RigServo limited(double angle, double rate, double acceleration) {
  RigServo servo;
  servo.angle_limit = angle;
  servo.rate_limit = rate;
  servo.acceleration_limit = acceleration;
  return servo;
}

AxisState state_of(double angle, double rate, double command) {
  return {angle, rate, 100 * (command - angle) - 10 * rate, command};
}

std::vector<double> guards_of(const ServoAxis& axis, const AxisState& state) {
  std::vector<double> values(ServoAxis::guards);
  axis.evaluate(state, values.data());
  return values;
}

}  // namespace

TEST_CASE("under a held acceleration the guards cross at the roots of a parabola") {
  ServoAxis axis(limited(0.5, 3, unlimited), {1, 0, 0});
  AxisState state{0, 0, 10, 10};
  AxisMode mode;
  axis.settle(state, mode);
  KnownAnswers answers;
  const HeldMotion from_rest{{0, 0}, 0, 0, 10};
  const ServoAxis::Crossing rate = axis.first_crossing(from_rest, 10, 0, 1, answers);
  CHECK(rate.guard == ServoAxis::rate_up);
  CHECK(rate.after == Approx(0.3).epsilon(1e-12));
  // If the stop is closer, the angle limit is reached first.
  const HeldMotion nearer{{0, 0}, 0.3, 0, 10};
  const ServoAxis::Crossing angle = axis.first_crossing(nearer, 10, 0, 1, answers);
  CHECK(angle.guard == ServoAxis::stop_up);
  CHECK(angle.after == Approx(0.2).epsilon(1e-12));
  CHECK(axis.first_crossing(from_rest, 10, 0, 0.29, answers).after == unlimited);
}

TEST_CASE("a stop stops a servo and holds it while it is pressed") {
  const double sign = GENERATE(1, -1);
  ServoAxis axis(limited(0.5, unlimited, unlimited), response);
  AxisState state = state_of(sign * 0.5, sign * 3, sign * 0.7);
  AxisMode mode;
  axis.settle(state, mode);
  CHECK(state.rate == 0);
  CHECK(state.angle == sign * 0.5);
  CHECK(state.demand == Approx(sign * 20));  // without the rate's damping
  CHECK(mode.demand_factor == 0);
  CHECK(guards_of(axis, state)[sign > 0 ? ServoAxis::stop_up : ServoAxis::stop_down] == Approx(20));
  // A command within the stop moves the servo off it.
  state = state_of(sign * 0.5, 0, sign * 0.4);
  axis.settle(state, mode);
  CHECK(mode.demand_factor == 1);
  CHECK(state.angle == sign * 0.5);
}

TEST_CASE("a motion within a servo's clearance needs no search") {
  ServoAxis axis(limited(0.5, 3, 40), response);
  AxisState state = state_of(0, 0, 0);
  AxisMode mode;
  axis.settle(state, mode);
  const ServoAxis::Clearance clearance = axis.clearance();
  CHECK(clearance.root == 10);
  CHECK(clearance.angle == Approx(0.5));
  CHECK(clearance.rate == Approx(3));
  CHECK(clearance.acceleration == Approx(40));
  CHECK(axis.stays_free(0.1, 0.1));
  CHECK_FALSE(axis.stays_free(0.5, 0.1));
  CHECK_FALSE(axis.stays_free(0.45, 0));  // 45 rad/s^2 back to its command
  // No clearance at a limit.
  state = state_of(0.6, 0, 1);
  axis.settle(state, mode);
  CHECK(axis.clearance().angle == 0);
}

TEST_CASE("a servo rests where its equation says, without stiffness at its command") {
  const auto rests_at = [](const ServoResponse& servo) {
    const ServoResponse at_rest = servo.at_rest();
    CHECK(at_rest.from_rate == 0);
    return at_rest.from_command / at_rest.from_angle;
  };
  CHECK(rests_at(response) == 1);
  CHECK(rests_at({90, 100, 10}) == 0.9);
  CHECK(rests_at({0, 0, 20}) == 1);  // first order
}

TEST_CASE("the smallest backlash engages at its edge, whatever the rounding of the angles") {
  for (int i = 0; i < 2000; ++i) {
    RigServo servo = limited(unlimited, unlimited, unlimited);
    servo.backlash = 1e-6 * (1 + 1e-3 * i);
    servo.offset = 0.013;
    ServoAxis axis(servo, response);
    AxisMode mode;
    AxisState state = state_of(-0.1 + 1e-4 * i, 0.5, 1);
    axis.settle(state, mode);
    CHECK(mode.ratio == 0);  // in the middle of the gap
    state = state_of(state.angle + servo.backlash / 2, 0.5, 1);
    axis.settle(state, mode);
    CHECK(mode.ratio == 1);
  }
}

}  // namespace bbsim_test::test_servo_axis
