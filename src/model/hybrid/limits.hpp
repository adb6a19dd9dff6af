// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Limits of the commands of a continuous law, and of motors; and integral parts that wait at a
// limit (control/law.hpp).
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "model/control/law.hpp"
#include "model/hybrid/part.hpp"

namespace bbsim::model {

// Limits of the commands of a continuous law, and integral parts that wait there.
class CommandLimits : public Part {
 public:
  explicit CommandLimits(SwitchedModel& model) : model_(model) {}

  [[nodiscard]] static std::size_t guards() { return std::size_t{2} * Guard::count; }
  void append_scales(std::vector<double>& scales) const;
  void evaluate(const GuardContext& now, double* values) const;
  // Records the limit that a command reached.
  void cross(std::size_t guard);
  // Sets the integral parts of commands that move along a limit: the limit determines them.
  void leave_mode(double t, double* z);
  // Determines whether each command is at its limit, and whether its integral part waits.
  [[nodiscard]] bool reset(double t, double* z);
  // A jump changes the commands: none is known to be exactly at its limit.
  void after_jump(double /*t*/, const double* /*z*/) { reached_[0] = reached_[1] = 0; }
  void reset_at_limits(double t, const double* z);

 private:
  // Guards per command: its two limits. At one limit, the other's guard watches the integral part.
  struct Guard {
    enum : std::size_t { high, low, count };
  };

  [[nodiscard]] const CommandRange& limit(std::size_t i) const {
    return model_.rig().command_limit[i];
  }
  [[nodiscard]] bool integrates(std::size_t i) const {
    return model_.with_loop([i](const auto& loop) { return loop.law().integrates(i); });
  }
  void put(std::size_t i, double side, AtLimit place, double push);
  [[nodiscard]] double push(std::size_t i, double t, const double* z) const;
  [[nodiscard]] OutwardRate outward_rate(std::size_t i, double side,
                                         const GuardContext& now) const {
    return {side * now.command_rates().raw[i], side * push(i, now.t, now.z)};
  }

  SwitchedModel& model_;
  double reached_[2]{0, 0};  // side of the limit that a command is exactly at, or 0
};

// Limits of the motors' torques, and integrals that wait at a limit
// (docs/explanation/losses-and-torques.md).
class MotorLimits : public Part {
 public:
  explicit MotorLimits(SwitchedModel& model)
      : model_(model), parts_(*model.get().dry), scene_(DryScene::of(model)) {}

  [[nodiscard]] static std::size_t guards() { return std::size_t{2} * Guard::count; }
  void append_scales(std::vector<double>& scales) const {
    scales.insert(scales.end(), guards(),
                  parts_.torque_limit < unlimited ? parts_.torque_limit : 1);
  }
  void evaluate(const GuardContext& now, double* values) const;
  // Records that the torque asked of a motor reached a limit.
  void cross(std::size_t guard);
  // Sets the integrals of torques that move along a limit: the limit determines them.
  void leave_mode(double t, double* z);
  // The jump takes the torque asked of the motor off its limit.
  void jump_command(std::size_t motor) {
    if (motor < 2) reached_[motor] = 0;
  }
  [[nodiscard]] bool reset(double t, double* z);
  void reset_at_limits(double t, const double* z);

 private:
  // Guards per motor: its limits by voltage and by torque. At a limit, the spare ones watch the
  // integral and the change to the other kind of limit.
  struct Guard {
    enum : std::size_t { voltage_up, voltage_down, torque_up, torque_down, count };
  };

  // The limits of a motor at a rate of its axis, N m.
  struct TorqueRange {
    double up, down;  // by the voltage
    double torque;

    [[nodiscard]] double by_voltage(double side) const { return side > 0 ? up : down; }
    // The torque at the limit on a side (1 or -1).
    [[nodiscard]] double at(double side) const {
      return std::clamp(by_voltage(side), -torque, torque);
    }
    // Whether the voltage limit on a side is tighter than the torque limit.
    [[nodiscard]] bool is_by_voltage(double side) const {
      return std::abs(by_voltage(side)) < torque;
    }
    // Whether the axis turns so fast that its motor brakes with full torque at every command,
    // because no voltage within the limit reduces the braking. Both limits of the torque are then
    // equal. The voltage limit is on the side that asks for less braking.
    [[nodiscard]] bool overruns() const { return up < -torque || down > torque; }
  };
  [[nodiscard]] TorqueRange range(std::size_t i, const double* z) const {
    const double rate = z[scene_.rate + i];
    return {parts_.by_voltage(1, rate), parts_.by_voltage(-1, rate), parts_.torque_limit};
  }

  [[nodiscard]] double push(std::size_t i, const GuardContext& now) const;
  [[nodiscard]] OutwardRate outward_rate(std::size_t i, double side, const GuardContext& now) const;
  void evaluate_along(std::size_t i, const GuardContext& now, double* values) const;
  void evaluate_not_along(std::size_t i, const GuardContext& now, double* values) const;

  SwitchedModel& model_;
  const DryParts& parts_;
  DryScene scene_;
  double reached_[2]{0, 0};  // side of the limit that a motor's torque is exactly at, or 0
};

}  // namespace bbsim::model
