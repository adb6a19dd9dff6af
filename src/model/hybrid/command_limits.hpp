// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Limits of the commands of a continuous law, and integral parts that wait at a limit
// (control/integral_limit.hpp).
#pragma once

#include "model/control/integral_limit.hpp"
#include "model/hybrid/part.hpp"

namespace bbsim::model {

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

}  // namespace bbsim::model
