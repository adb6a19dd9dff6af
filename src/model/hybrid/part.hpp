// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The interface of all parts of a scene that switch: what HybridSystem asks of each.
//
// A part hides the functions that concern it. Calls are resolved when compiled, so the rest cost
// nothing. All functions take the time t (s) and the states z.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "model/hybrid/switched_model.hpp"

namespace bbsim::model {

// What the guards of several parts need at an instant, each computed at most once.
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
  // Of a coupled scene.
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
  // The next time event, s. Then the next one that may change the motion.
  [[nodiscard]] static double next_time() { return unlimited; }
  [[nodiscard]] static double next_change() { return unlimited; }
  // Handles what is due by t and does not change the motion.
  static void observe(double /*t*/, const double* /*z*/) {}

  // The guards, each positive until its event: how many, the scale of each, and their values.
  [[nodiscard]] static std::size_t guards() { return 0; }
  static void append_scales(std::vector<double>& /*scales*/) {}
  static void evaluate(const GuardContext& /*now*/, double* /*values*/) {}
  // A guard of this part, counted from 0, fell through zero. reset() follows.
  static void cross(std::size_t /*guard*/) {}

  // A switch calls the following, in this order, for all parts each.
  //
  // Restores states that the present mode determines, before anything changes.
  static void leave_mode(double /*t*/, double* /*z*/) {}
  // The command to a servo jumps.
  static void jump_command(std::size_t /*servo*/) {}
  // The reset map: chooses the mode from here on, and may change z. If it returns true, states
  // jumped: all parts hear of it by after_jump(), and the first part begins again.
  [[nodiscard]] static bool reset(double /*t*/, double* /*z*/) { return false; }
  static void after_jump(double /*t*/, const double* /*z*/) {}
  // Chooses how a quantity exactly at its limit continues, by its rate. The other modes are known.
  static void reset_at_limits(double /*t*/, const double* /*z*/) {}

  // Saves or restores the state (base/archive.hpp).
  template <class Archive>
  static void archive(Archive& /*archive*/) {}
};

}  // namespace bbsim::model
