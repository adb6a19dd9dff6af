// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The switches of one servo: its limits, stops, backlash and dead band. Between two switches an
// AxisMode describes its motion; a switch occurs when a guard crosses zero.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "model/servo/held_motion.hpp"
#include "model/servo/servo.hpp"

namespace bbsim::model {

// The motion of a stepper motor's shaft. Under bbsim's own laws it follows a trapezoidal ramp:
// constant acceleration, constant rate, constant deceleration. The driver plans it anew at each
// target, from the present motion, as AccelStepper does. Under a sketch's pulses the shaft moves at
// a constant rate from sample to sample.

// The part of a ramp from an instant on, in which the acceleration is constant.
struct RampPart {
  enum class Until { ever, angle, rate };

  double acceleration = 0;  // rad/s^2
  Until until = Until::ever;
  bool rising = true;  // the angle or the rate comes to the level from below
  double level = 0;    // rad, or rad/s
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
inline RampPart next_part(double& angle, double& rate, double target, const RigServo& servo) {
  const double most = servo.acceleration_limit;
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
  constexpr double at_limit = 1 - 1e-11;  // limits are reached up to rounding
  const double halt =
      servo.rate_limit * servo.rate_limit / (2 * most);  // the way from the limit to rest
  part.until = RampPart::Until::angle;
  part.rising = way > 0;
  if (speed >= servo.rate_limit * at_limit) {
    rate = way * servo.rate_limit;
    part.level = target - way * halt;
    return part;
  }
  part.acceleration = way * most;
  // Halfway between the target and where the motion would have begun at rest.
  part.level = (target + angle - way * speed * speed / (2 * most)) / 2;
  const double to_limit = halt - speed * speed / (2 * most);
  if (way * (part.level - angle) > to_limit) {
    part.until = RampPart::Until::rate;
    part.level = way * servo.rate_limit;
  }
  return part;
}

// The state of an axis at an instant.
struct AxisState {
  double angle = 0, rate = 0;  // of the servo, rad and rad/s
  double demand = 0;           // acceleration in free motion, rad/s^2
  double command = 0;          // rad
};

// A guard's value, positive until a switch: a linear function of an AxisState.
struct AxisMargin {
  double constant = 0, by_angle = 0, by_rate = 0, by_demand = 0, by_command = 0;

  [[nodiscard]] double at(const AxisState& state) const {
    return constant + by_angle * state.angle + by_rate * state.rate + by_demand * state.demand +
           by_command * state.command;
  }
};

class ServoAxis {
 public:
  // Guards of the limits in both directions; at a limit, they watch for leaving it. For backlash,
  // the first one alone watches for the end of contact.
  enum Guard {
    acceleration_up,
    acceleration_down,
    rate_up,
    rate_down,
    stop_up,
    stop_down,
    gap_up,
    gap_down,
    guards
  };

  // `servo` includes the offset of the plane, or of the horn, at the servo's zero.
  ServoAxis(const RigServo& servo, const ServoResponse& response)
      : servo_(servo), response_(response), root_(std::sqrt(response.from_angle)) {}

  // Takes a new command and returns the command that the servo follows. The dead band keeps the old
  // command if the new one is too close to it. A stepper rounds commands to microsteps.
  [[nodiscard]] double follow(double command) {
    if (servo_.step > 0 && !follows_pulses()) {
      command = servo_.step * std::round(command / servo_.step);
    }
    if (std::abs(command - target_) > servo_.dead_band) {
      target_ = command;
      has_new_target_ = true;
    }
    return target_;
  }

  // A fast test that succeeds in most cases: whether settle() would leave the servo free and within
  // its limits, under the command that it follows.
  [[nodiscard]] bool stays_free(double angle, double rate) const {
    if (!(std::abs(angle) < calm_angle_ && std::abs(rate) < calm_rate_)) return false;
    const double most = servo_.acceleration_limit;
    return most == unlimited ||
           std::abs(response_.from_command * target_ - response_.from_angle * angle -
                    response_.from_rate * rate) <= most;
  }

  // Chooses the mode from here on. May change the rate: a stop sets it to zero, and a first-order
  // servo takes it from its command.
  void settle(AxisState& state, AxisMode& mode);

  // The angle of a stepper's field: ratio * the driver's count + offset, rad.
  struct Field {
    double ratio = 1, offset = 0;
  };
  [[nodiscard]] Field field() const { return field_; }

  // Whether settle() has found since the last call that a stepper's torque is too small: its shaft
  // stalls while the driver's field runs on.
  [[nodiscard]] bool takes_loss() { return std::exchange(loses_, false); }

  // Writes `guards` values; all are positive until a switch.
  void evaluate(const AxisState& state, double* values) const;

  // The first guard that crosses zero within (0, end] in a motion under a held command. Times count
  // from `start`, s.
  struct Crossing {
    double after = unlimited;  // s; infinite if none crosses
    int guard = 0;
  };
  [[nodiscard]] Crossing first_crossing(const HeldMotion& motion, double command, double start,
                                        double end, KnownAnswers& answers) const;

  // Bounds for a free servo with stiffness: no guard crosses zero while its angle, rate and
  // acceleration stay below them. Bounds of 0 mean that other guards need checking.
  struct Clearance {
    double angle, rate, acceleration;  // rad, rad/s, rad/s^2
    double root;                       // of the stiffness, rad/s

    // Whether a motion within these bounds, by this law, cannot make a guard cross zero.
    [[nodiscard]] bool holds(const MotionReach& reached, const HeldLaw& law) const {
      return reached.rate_most < rate && std::abs(reached.centre) + reached.angle_most < angle &&
             law.stiffness * reached.angle_most + law.damping * reached.rate_most < acceleration;
    }
  };
  [[nodiscard]] Clearance clearance() const;

  // The scale of each guard's value.
  void scales(double* values) const;

 private:
  // Free, on a stepper's ramp, or at one of the limits.
  enum class Motion { free, on_ramp, accelerating, at_rate, at_stop };
  enum class Play { none, contact, gap };

  void plan_ramp(AxisState& state);
  void settle_stall(const AxisState& state, AxisMode& mode);
  // The rate at which a stepper's torque no longer gives the ramp's acceleration, rad/s.
  [[nodiscard]] double stall_rate() const;
  [[nodiscard]] bool follows_pulses() const { return servo_.pulse_time > 0; }
  // Calls use(guard, margin) for each active guard.
  template <class Use>
  void for_each_margin(Use use) const;
  [[nodiscard]] Motion choose(AxisState& state);
  void settle_backlash(const AxisState& state, AxisMode& mode);
  [[nodiscard]] double drive(const AxisState& state) const;
  // Drive of a servo further outward at its rate limit: an acceleration; for first order, the rate
  // by its law minus the present rate.
  [[nodiscard]] AxisMargin push() const;
  // Drive of a servo against a stop: an acceleration; for first order, command minus angle.
  [[nodiscard]] AxisMargin push_at_stop() const;

  // The scale of the guards of the gap, rad. They are small differences of angles, so the rounding
  // of the angles counts, too: it may exceed that of a small backlash.
  [[nodiscard]] double gap_scale(double angle) const {
    return std::max(servo_.backlash, 0.01 * std::max(1.0, std::abs(angle)));
  }

  // Guards below this fraction of their scale count as zero.
  static constexpr double guard_rounding = 1e-12;
  // Fraction of a limit that counts as at it, because guards are zero only to rounding.
  static constexpr double at_limit = 1 - 1e-11;

  double target_ = 0;                      // the followed command
  bool has_new_target_ = false;            // since settle()
  double calm_angle_ = 0, calm_rate_ = 0;  // limits for stays_free()
  RigServo servo_;
  ServoResponse response_;
  double root_;  // of the stiffness in free motion, rad/s
  Motion motion_ = Motion::free;
  int limit_side_ = 1;  // 1 or -1: the motion is at the upper or lower limit
  RampPart ramp_;
  // Of a stepper that stalls: its driver's angle then, that at which the shaft follows again, and
  // the direction in which the driver comes there; 0: not before the next target.
  bool stalls_ = false, may_stall_ = false, loses_ = false;
  double stalled_at_ = 0, caught_at_ = 0, catches_ = 0;
  double lost_ = 0;  // the driver's angle less the field's while the shaft follows, rad
  Field field_;
  Play play_ = Play::none;
  int contact_side_ = 1;  // 1 or -1: the servo pushes the plane up or down
  bool started_ = false;
  double plane_ = 0;  // angle in the gap, rad
};

}  // namespace bbsim::model
