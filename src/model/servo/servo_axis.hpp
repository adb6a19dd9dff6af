// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What one servo does: free, at a limit, at a stop; its backlash and its dead band. Between two
// switches it is an AxisMode; each switch is where one of the guards falls through zero.
#pragma once

#include <cmath>

#include "base/archive.hpp"
#include "model/servo/held_motion.hpp"
#include "model/systems/rig.hpp"

namespace bbsim::model {

// One axis at an instant.
struct AxisState {
  double angle = 0, rate = 0;  // of the servo, rad and rad/s
  double demand = 0;           // acceleration in free motion, rad/s^2
  double command = 0;          // rad
};

// What is positive until something switches: a sum of parts of an AxisState.
struct AxisMargin {
  double constant = 0, by_angle = 0, by_rate = 0, by_demand = 0, by_command = 0;

  [[nodiscard]] double at(const AxisState& state) const {
    return constant + by_angle * state.angle + by_rate * state.rate + by_demand * state.demand +
           by_command * state.command;
  }
};

class ServoAxis {
 public:
  static constexpr int guards = 8;

  // The offset of `servo` is where the plane, or the horn, is at its zero.
  ServoAxis(const RigServo& servo, const ServoResponse& response)
      : servo_(servo), response_(response), root_(std::sqrt(response.from_angle)) {}

  // The command that the servo follows after it got this one: nearer to the last one than the dead
  // band it is not followed.
  [[nodiscard]] double follow(double command) {
    if (std::abs(command - target_) > servo_.dead_band) target_ = command;
    return target_;
  }

  // Whether settle() would find the servo as it left it, free and short of its limits, under the
  // command that it follows: mostly.
  [[nodiscard]] bool stays_free(double angle, double rate) const {
    if (!(std::abs(angle) < calm_angle_ && std::abs(rate) < calm_rate_)) return false;
    const double most = servo_.acceleration_limit;
    return most == unlimited ||
           std::abs(response_.from_command * target_ - response_.from_angle * angle -
                    response_.from_rate * rate) <= most;
  }

  // Chooses what the servo does from here. May change its rate: a stop takes it, and a servo of
  // first order has it from its command.
  void settle(AxisState& state, AxisMode& mode);

  // Positive as long as nothing switches; `guards` numbers.
  void evaluate(const AxisState& state, double* values) const;

  // The first guard that falls in a motion under a held command, within (0, end]; times count from
  // `start`, s.
  struct Fall {
    double after = unlimited;  // s; infinite if none does
    int guard = 0;
  };
  [[nodiscard]] Fall first_fall(const HeldMotion& motion, double command, double start, double end,
                                KnownAnswers& answers) const;

  // While a servo moves freely by a spring's law, what switches it no sooner than its angle, its
  // rate or its acceleration reaches as much: nothing of it positive if there is more to look at.
  struct Clearance {
    double angle, rate, acceleration;  // rad, rad/s, rad/s^2
    double root;                       // of the stiffness, rad/s

    // Of a motion by that law.
    [[nodiscard]] bool holds(const MotionReach& reached, const HeldLaw& law) const {
      return reached.rate_most < rate && std::abs(reached.centre) + reached.angle_most < angle &&
             law.stiffness * reached.angle_most + law.damping * reached.rate_most < acceleration;
    }
  };
  [[nodiscard]] Clearance clearance() const;

  // The size of each guard's quantity.
  void scales(double* values) const;

  // What it does at present (base/archive.hpp).
  template <class Archive>
  void archive(Archive& archive) {
    archive.enumerated(motion_, Motion::stop_down);
    archive.enumerated(play_, Play::gap);
    archive(started_, target_, plane_, calm_angle_, calm_rate_);
    archive.require(is_finite(target_, plane_) && is_number(calm_angle_) && is_number(calm_rate_));
  }

 private:
  enum class Motion {
    free,
    accelerating_up,
    accelerating_down,
    rate_up,
    rate_down,
    stop_up,
    stop_down
  };
  enum class Play { none, up, down, gap };

  // Calls use(guard, margin) for each that is looked out for.
  template <class Use>
  void for_each_margin(Use use) const;
  [[nodiscard]] Motion choose(AxisState& state) const;
  void settle_backlash(const AxisState& state, AxisMode& mode);
  [[nodiscard]] double drive(const AxisState& state) const;
  // What pushes a servo at its rate limit further: an acceleration, or, of first order, what the
  // rate would be beyond the present one.
  [[nodiscard]] AxisMargin push() const;
  // What pushes it against a stop: an acceleration, or how far the command is beyond.
  [[nodiscard]] AxisMargin push_at_stop() const;

  // Guards within this part of their scale are zero.
  static constexpr double guard_rounding = 1e-12;
  // A guard that was found at zero is this near it.
  static constexpr double at_limit = 1 - 1e-11;

  double target_ = 0;                      // the command that is followed
  double calm_angle_ = 0, calm_rate_ = 0;  // up to where stays_free()
  RigServo servo_;
  ServoResponse response_;
  double root_;  // of the stiffness, in free motion
  Motion motion_ = Motion::free;
  Play play_ = Play::none;
  bool started_ = false;
  double plane_ = 0;  // the plane's angle in the gap, rad
};

}  // namespace bbsim::model
