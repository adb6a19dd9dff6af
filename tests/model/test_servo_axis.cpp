// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The modes of one servo, its guards and their zero crossings, against closed forms.
#include <cmath>
#include <vector>

#include "catch.hpp"
#include "model/servo/servo_axis.hpp"

namespace bbsim_test::test_servo_axis {

using namespace bbsim::model;

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

TEST_CASE("a servo within its limits is free, and its guards are the distances to them") {
  ServoAxis axis(limited(0.5, 3, 40), response);
  AxisState state = state_of(0.1, 0.5, 0.3);  // accelerates by 15
  AxisMode mode;
  axis.settle(state, mode);
  CHECK(mode.demand_factor == 1);
  CHECK(mode.set_acceleration == 0);
  CHECK(mode.ratio == 1);
  const std::vector<double> guards = guards_of(axis, state);
  const double expected[] = {25, 55, 2.5, 3.5, 0.4, 0.6};
  for (std::size_t i = 0; i < 6; ++i) CHECK(guards[i] == Approx(expected[i]).epsilon(1e-12));
  CHECK(guards[ServoAxis::gap_up] == unlimited);  // no backlash
  CHECK(guards[ServoAxis::gap_down] == unlimited);
}

TEST_CASE("a servo at its acceleration limit leaves it when less is demanded") {
  const double sign = GENERATE(1, -1);
  ServoAxis axis(limited(unlimited, unlimited, 12), response);
  AxisState state = state_of(0, 0, sign * 0.2);  // demands 20
  AxisMode mode;
  axis.settle(state, mode);
  CHECK(mode.demand_factor == 0);
  CHECK(mode.set_acceleration == sign * 12);
  CHECK(guards_of(axis,
                  state)[sign > 0 ? ServoAxis::acceleration_up : ServoAxis::acceleration_down] ==
        Approx(8));
  CHECK(guards_of(axis,
                  state)[sign > 0 ? ServoAxis::acceleration_down : ServoAxis::acceleration_up] ==
        unlimited);
  state = state_of(sign * 0.1, 0, sign * 0.2);  // demands 10
  CHECK(guards_of(axis,
                  state)[sign > 0 ? ServoAxis::acceleration_up : ServoAxis::acceleration_down] ==
        Approx(-2));
  axis.settle(state, mode);
  CHECK(mode.demand_factor == 1);
}

TEST_CASE("a servo at its rate limit turns at a constant rate until the demand reverses") {
  ServoAxis axis(limited(unlimited, 2, unlimited), response);
  AxisState state = state_of(0, 2 - 1e-13, 1);  // crossings are found up to rounding
  AxisMode mode;
  axis.settle(state, mode);
  CHECK(state.rate == 2);
  CHECK(mode.demand_factor == 0);
  CHECK(mode.set_acceleration == 0);
  CHECK(guards_of(axis, state)[ServoAxis::rate_up] == Approx(80));  // the demand beyond the limit
  state = state_of(0.9, 2, 1);                                      // demands -10
  axis.settle(state, mode);
  CHECK(mode.demand_factor == 1);
  CHECK(state.rate == 2);
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

TEST_CASE("a servo of first order takes its rate from the command") {
  RigServo servo = limited(unlimited, 2, unlimited);
  servo.time_constant = 0.1;
  ServoAxis axis(servo, {0, 0, 10});
  AxisMode mode;
  AxisState state{0.1, 0, 0, 0.2};
  axis.settle(state, mode);
  CHECK(state.rate == Approx(1));
  CHECK(mode.demand_factor == 1);
  state = {0.1, 0, 0, 0.5};  // demands 4 rad/s
  axis.settle(state, mode);
  CHECK(state.rate == 2);
  CHECK(mode.demand_factor == 0);
  CHECK(guards_of(axis, state)[ServoAxis::rate_up] == Approx(2));
}

TEST_CASE("the plane rests in the gap until the servo has taken up the backlash") {
  RigServo servo;
  servo.backlash = 0.02;
  servo.offset = 0.3;
  ServoAxis axis(servo, response);
  AxisMode mode;
  AxisState state = state_of(0.1, 1, 1);
  axis.settle(state, mode);  // the plane starts in the middle of the gap
  CHECK(mode.ratio == 0);
  CHECK(mode.offset == Approx(0.4));
  CHECK(guards_of(axis, state)[ServoAxis::gap_up] == Approx(0.01));
  CHECK(guards_of(axis, state)[ServoAxis::gap_down] == Approx(0.01));
  state = state_of(0.11, 1, 1);
  axis.settle(state, mode);
  CHECK(mode.ratio == 1);
  CHECK(mode.ratio * state.angle + mode.offset == Approx(0.4));  // no jump
  CHECK(guards_of(axis, state)[ServoAxis::gap_up] == 1);         // the rate
  // The servo turns back, the plane stays.
  state = state_of(0.2, -1e-6, -1);
  axis.settle(state, mode);
  CHECK(mode.ratio == 0);
  CHECK(mode.offset == Approx(0.49));
}

TEST_CASE("a servo follows commands beyond its dead band only") {
  RigServo servo;
  servo.dead_band = 0.01;
  ServoAxis axis(servo, response);
  CHECK(axis.follow(0.009) == 0);
  CHECK(axis.follow(0.011) == 0.011);
  CHECK(axis.follow(0.002) == 0.011);
  CHECK(axis.follow(-0.1) == -0.1);
}

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
