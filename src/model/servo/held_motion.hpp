// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The motion of a servo under a held command between two switches, in closed form.
//
// In every mode of a servo (free, of first or second order; at its acceleration limit, its rate
// limit, or a stop) it obeys
//     q'' = push - damping q' - stiffness q
// with constant coefficients. Let a = q''(0), let h be the impulse response (h'' + damping h' +
// stiffness h = 0, h(0) = 0, h'(0) = 1), and g the integral of h. Then
//     q   = q(0) + (h + damping g) q'(0) + g a
//     q'  = (h' + damping h) q'(0) + h a
//     q'' = -stiffness h q'(0) + h' a
// These hold in all modes, and stay accurate as damping or stiffness vanish.
//
// The shaft of a stepper that rings about a field with the acceleration b has stiffness times a
// quadratic in time added to its push. A parabola with the acceleration b solves this equation: the
// drift. What is left of the motion obeys the formulas above.
#pragma once

#include <array>
#include <cmath>

#include "model/servo/impulse_series.hpp"
#include "model/systems/rig_loop.hpp"

namespace bbsim::model {

struct HeldLaw {
  double stiffness = 0, damping = 0;  // 1/s^2, 1/s

  bool operator==(const HeldLaw&) const = default;
};

// The impulse response h with its integral and its derivative.
struct ImpulseAnswer {
  double integral = 0, value = 0, slope = 1;  // s^2, s, 1
};

// Whether the power series of the response has at most about twenty terms at `time` (s), none of
// them much larger than the sum.
[[nodiscard]] inline bool suits_series(const HeldLaw& law, double time) {
  return law.damping * time <= 1.5 && law.stiffness * time * time <= 1;
}

// The response at `time` (s) after the impulse.
[[nodiscard]] ImpulseAnswer answer(const HeldLaw& law, double time);

// The motion of one servo from a given instant on.
struct HeldMotion {
  HeldLaw law;
  double angle = 0, rate = 0, acceleration = 0;   // at the start, without the drift's
  double drift_rate = 0, drift_acceleration = 0;  // rad/s at the start, rad/s^2

  struct ServoState {
    double angle, rate, acceleration;
  };
  [[nodiscard]] ServoState after(double time) const { return after(answer(law, time), time); }
  [[nodiscard]] ServoState after(const ImpulseAnswer& at, double time) const {
    const double turned = drift_acceleration * time;
    const double drift = time * (drift_rate + turned / 2);
    return {(angle + drift) +
                ((at.value + law.damping * at.integral) * rate + at.integral * acceleration),
            (at.slope + law.damping * at.value) * rate +
                (at.value * acceleration + (drift_rate + turned)),
            (at.slope * acceleration + drift_acceleration) - law.stiffness * at.value * rate};
  }
};

// Of the servos of a gimbal. A gimbal with two servos leaves the third at rest.
using HeldMotions = std::array<HeldMotion, most_servos>;

// The motion of servo i in the given mode from an angle (rad) and a rate (rad/s) at time t, s.
[[nodiscard]] HeldMotion held_motion(const ServoResponse& servo, const RigMode& of, std::size_t i,
                                     double angle, double rate, double t);

// A linear function of the motion: constant + by_angle q + by_rate q'.
struct MotionLine {
  double constant, by_angle = 0, by_rate = 0;

  [[nodiscard]] double at(double angle, double rate) const {
    return constant + by_angle * angle + by_rate * rate;
  }
};

// Bounds on the motion over a time: |angle - centre| <= angle_most, |rate| <= rate_most.
struct MotionReach {
  double centre, angle_most, rate_most;

  [[nodiscard]] double least(const MotionLine& line) const {
    return line.constant + line.by_angle * centre - std::abs(line.by_angle) * angle_most -
           std::abs(line.by_rate) * rate_most;
  }
};
[[nodiscard]] MotionReach reach(const HeldMotion& motion, double end);
// Bounds for a servo with positive stiffness, without a square root, and up to 1.42 times wider.
// `root` is the square root of the stiffness.
[[nodiscard]] inline MotionReach reach_about(const HeldMotion& motion, double root) {
  const double inverse = 1 / root;
  const double spring =
      (motion.acceleration + motion.law.damping * motion.rate) * inverse * inverse;
  const double most = std::abs(spring) + std::abs(motion.rate) * inverse;
  return {motion.angle + spring, most, most * root};
}

// Caches series coefficients of the last law's impulse response, so that no term waits for the one
// before. Also caches the last response at the end of an interval, which most lines and servos
// share.
class KnownAnswers {
 public:
  [[nodiscard]] ImpulseAnswer at(const HeldLaw& law, double time);
  const ImpulseAnswer& at_end(const HeldLaw& law, double end) {
    if (!(law == ending_ && end == end_)) {
      ending_ = law;
      end_ = end;
      answer_ = at(law, end);
    }
    return answer_;
  }

 private:
  HeldLaw ending_, law_;
  double end_ = 0;
  ImpulseAnswer answer_;
  int known_ = 0;                           // of coefficients_, after the first
  double coefficients_[most_terms + 1]{1};  // of h(t) / t for law_
};

// The first time within (0, end] at which the line falls to zero, s; infinite if it does not.
// If it starts no more than `clearly` above zero, it must fall by `clearly` below zero and below
// its start, unless it rises above `clearly` first. Exact up to the rounding of the time `start` +
// t.
[[nodiscard]] double first_crossing(const MotionLine& line, const HeldMotion& motion,
                                    double clearly, double start, double end,
                                    KnownAnswers& answers);

}  // namespace bbsim::model
