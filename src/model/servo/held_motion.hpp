// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A servo between two switches under a command that is held: its motion in closed form.
//
// In every mode of a rig (free, of first or second order; at its acceleration limit; at its rate
// limit; at a stop) it moves as
//     q'' = push - damping q' - stiffness q
// with constants. With a = q''(0) of the start, and h the answer to an impulse (h'' + damping h' +
// stiffness h = 0, h(0) = 0, h'(0) = 1), g its integral:
//     q   = q(0) + (h + damping g) q'(0) + g a
//     q'  = (h' + damping h) q'(0) + h a
//     q'' = -stiffness h q'(0) + h' a
// which has no case of its own for any of them, and loses nothing where damping or stiffness
// vanish.
#pragma once

#include <cmath>

#include "model/servo/impulse_series.hpp"
#include "model/systems/rig_loop.hpp"

namespace bbsim::model {

struct HeldLaw {
  double stiffness = 0, damping = 0;  // 1/s^2, 1/s

  bool operator==(const HeldLaw&) const = default;
};

// h, its derivative and its integral.
struct ImpulseAnswer {
  double integral = 0, value = 0, slope = 1;  // s^2, s, 1
};

// Whether the power series of the answer has at most some twenty terms at `time` (s), and none that
// is much larger than their sum.
[[nodiscard]] inline bool suits_series(const HeldLaw& law, double time) {
  return law.damping * time <= 1.5 && law.stiffness * time * time <= 1;
}

// At `time` (s) after the impulse.
[[nodiscard]] ImpulseAnswer answer(const HeldLaw& law, double time);

// Of one servo from some instant on.
struct HeldMotion {
  HeldLaw law;
  double angle = 0, rate = 0, acceleration = 0;  // at the start

  struct Instant {
    double angle, rate, acceleration;
  };
  [[nodiscard]] Instant after(double time) const { return after(answer(law, time)); }
  [[nodiscard]] Instant after(const ImpulseAnswer& at) const {
    return {angle + ((at.value + law.damping * at.integral) * rate + at.integral * acceleration),
            (at.slope + law.damping * at.value) * rate + at.value * acceleration,
            at.slope * acceleration - law.stiffness * at.value * rate};
  }
};

// In the present mode, from an angle and a rate on.
[[nodiscard]] HeldMotion held_motion(const ServoResponse& servo, const AxisMode& mode,
                                     double command, double angle, double rate);

// Something that depends on the motion alone: constant + by_angle q + by_rate q'.
struct MotionLine {
  double constant, by_angle = 0, by_rate = 0;

  [[nodiscard]] double at(double angle, double rate) const {
    return constant + by_angle * angle + by_rate * rate;
  }
};

// Where a motion stays for a time: |angle - centre| <= angle_most, |rate| <= rate_most.
struct MotionReach {
  double centre, angle_most, rate_most;

  [[nodiscard]] double least(const MotionLine& line) const {
    return line.constant + line.by_angle * centre - std::abs(line.by_angle) * angle_most -
           std::abs(line.by_rate) * rate_most;
  }
};
[[nodiscard]] MotionReach reach(const HeldMotion& motion, double end);
// The same of a servo with a spring, without taking a root, and up to 1.42 times wider. `root` is
// that of the stiffness.
[[nodiscard]] inline MotionReach reach_about(const HeldMotion& motion, double root) {
  const double inverse = 1 / root;
  const double spring =
      (motion.acceleration + motion.law.damping * motion.rate) * inverse * inverse;
  const double most = std::abs(spring) + std::abs(motion.rate) * inverse;
  return {motion.angle + spring, most, most * root};
}

// Answers of the law that was last asked for, by the coefficients of its series in powers of the
// time: no term waits for the one before. And the last one at the end of what is looked at, which
// lines and servos mostly have in common.
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
  int known_ = 0;                           // coefficients after the first one
  double coefficients_[most_terms + 1]{1};  // of law_: those of h(t) / t
};

// The first time within (0, end] at which the line falls to zero, s; infinite if it does not. If it
// starts no more than `clearly` above zero, it has to fall clearly below, or to have risen clearly
// above before. To the rounding of the time, which counts from `start`.
[[nodiscard]] double first_fall(const MotionLine& line, const HeldMotion& motion, double clearly,
                                double start, double end, KnownAnswers& answers);

}  // namespace bbsim::model
