// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Interface of the switching parts of a scene to HybridSystem.
//
// A part hides the functions that it needs with its own. Calls are resolved at compile time, so the
// others cost nothing. t is the time (s), z the states.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "model/hybrid/switched_model.hpp"

namespace bbsim::model {

// Values at an instant that the guards of several parts need, each computed at most once.
class GuardContext {
 public:
  GuardContext(const SwitchedModel& model, double time, const double* states)
      : t(time), z(states), model_(model) {}

  const double t;         // s
  const double* const z;  // the states

  [[nodiscard]] const Demands& demands() const {
    if (!demands_) demands_ = model_.demands(t, z);
    return *demands_;
  }
  [[nodiscard]] const CommandRates& command_rates() const {
    if (!rates_) rates_ = model_.command_rates(t, z);
    return *rates_;
  }
  // For coupled scenes only.
  [[nodiscard]] const Balance<double>& balance() const {
    if (!balance_) balance_ = model_.balance(t, z);
    return *balance_;
  }

 private:
  const SwitchedModel& model_;
  mutable std::optional<Demands> demands_;
  mutable std::optional<CommandRates> rates_;
  mutable std::optional<Balance<double>> balance_;
};

// The effect of an event. `restart`: the integrator must restart.
enum class Effect { none, restart, stop };

struct Part {
  // Time of the next time event, and of the next one that may change the motion, s.
  [[nodiscard]] static double next_time() { return unlimited; }
  [[nodiscard]] static double next_change() { return unlimited; }
  // Handles events due by t that do not change the motion.
  static void observe(double /*t*/, const double* /*z*/) {}

  // The guards, each positive until its event: their number, scales and values.
  [[nodiscard]] static std::size_t guards() { return 0; }
  static void append_scales(std::vector<double>& /*scales*/) {}
  static void evaluate(const GuardContext& /*now*/, double* /*values*/) {}
  // Called when a guard of this part, counted from 0, falls through zero. reset() follows.
  static void cross(std::size_t /*guard*/) {}

  // A switch calls each of the following for all parts, in this order.
  //
  // Restores states that the present mode determines, before anything changes.
  static void leave_mode(double /*t*/, double* /*z*/) {}
  // Called when the command to a servo jumps.
  static void jump_command(std::size_t /*servo*/) {}
  // The reset map: chooses the next mode, and may change z. Returns whether states jumped. If so,
  // after_jump() is called for all parts, and the resets start again with the first part.
  [[nodiscard]] static bool reset(double /*t*/, double* /*z*/) { return false; }
  static void after_jump(double /*t*/, const double* /*z*/) {}
  // Chooses by its rate how a quantity exactly at its limit continues. All other modes are known.
  static void reset_at_limits(double /*t*/, const double* /*z*/) {}
};

}  // namespace bbsim::model
