// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The motion of a stepper motor's shaft. Under bbsim's own laws it follows a trapezoidal ramp:
// constant acceleration, constant rate, constant deceleration. The driver plans it anew at each
// target, from the present motion, as AccelStepper does. Under a sketch's pulses the shaft moves at
// a constant rate from sample to sample.
#pragma once

#include <cmath>

namespace bbsim::model {

// The part of a ramp from an instant on, in which the acceleration is constant.
struct RampPart {
  enum class Until { ever, angle, rate };

  double acceleration = 0;  // rad/s^2
  Until until = Until::ever;
  bool rising = true;  // the angle or the rate comes to the level from below
  double level = 0;    // rad, or rad/s
};

struct RampLimits {
  double rate = 0, acceleration = 0;  // rad/s, rad/s^2
};

// Angles closer than this are the same. It exceeds their rounding; moves so small take no time.
constexpr double same_angle = 1e-9;  // rad

// The part from here to the target at this rate. It ends just beyond the target, so that a command
// that comes as the shaft arrives ends it first. Halts at the target.
inline RampPart part_at_rate(double& angle, double& rate, double target) {
  RampPart part;
  if (std::abs(target - angle) <= 2 * same_angle) {
    angle = target;
    rate = 0;
  } else if ((target - angle) * rate > 0) {
    part.until = RampPart::Until::angle;
    part.rising = rate > 0;
    part.level = target + (part.rising ? same_angle : -same_angle);
  } else {
    rate = 0;
  }
  return part;
}

// The part that begins with this motion. Sets the motion to the target where it arrives there.
inline RampPart next_part(double& angle, double& rate, double target, const RampLimits& limits) {
  const double most = limits.acceleration;
  const double left = target - (angle + rate * std::abs(rate) / (2 * most));  // after a halt
  if (std::abs(left) <= same_angle && rate * rate <= 2 * most * same_angle) {
    angle = target;
    rate = 0;
    return {};
  }
  const double way = left < 0 ? -1 : 1;
  RampPart part;
  const double speed = way * rate;  // towards the target
  const bool brakes = std::abs(left) <= same_angle, returns = !brakes && speed < 0;
  if (brakes || returns) {
    part.acceleration = rate > 0 ? -most : most;
    part.until = RampPart::Until::rate;
    part.rising = rate < 0;
    return part;
  }
  constexpr double at_limit = 1 - 1e-11;                       // limits are reached up to rounding
  const double halt = limits.rate * limits.rate / (2 * most);  // the way from the limit to rest
  part.until = RampPart::Until::angle;
  part.rising = way > 0;
  if (speed >= limits.rate * at_limit) {
    rate = way * limits.rate;
    part.level = target - way * halt;
    return part;
  }
  part.acceleration = way * most;
  // Halfway between the target and where the motion would have begun at rest.
  part.level = (target + angle - way * speed * speed / (2 * most)) / 2;
  const double to_limit = halt - speed * speed / (2 * most);
  if (way * (part.level - angle) > to_limit) {
    part.until = RampPart::Until::rate;
    part.level = way * limits.rate;
  }
  return part;
}

}  // namespace bbsim::model
