// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Assembles a Scenario into a Model: the smallest system that gives the scene's answer.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "model/events/event_monitors.hpp"
#include "model/systems/list.hpp"
#include "model/systems/rig.hpp"
#include "scenario/integrals.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::model {

// The parts of a coupled scene that switch, besides servos and samples.
struct DryParts {
  bool rolling = false, pivoting = false;  // rolling resistance, pivoting friction
  bool slides = false;
  double static_friction = 0;       // sliding starts when friction demand exceeds it
  double friction = 0;              // of the motors, N m
  double torque_limit = unlimited;  // of a motor, N m
  bool integrates = false;          // the position loop has an integral
  // At the voltage limit, the torque in a direction is stall_torque - torque_by_rate rate; infinite
  // without a voltage limit.
  double stall_torque = unlimited, torque_by_rate = 0;  // N m, N m s
  std::optional<OnEvent> rest{}, stick{};               // set if the scene has these events

  [[nodiscard]] bool limits_torque() const {
    return torque_limit < unlimited || stall_torque < unlimited;
  }
  [[nodiscard]] bool switches() const {
    return rolling || pivoting || slides || friction > 0 || limits_torque();
  }
  // The torque at the voltage limit in direction `sign` (1 or -1), at a rate.
  [[nodiscard]] double by_voltage(double sign, double rate) const {
    return sign * stall_torque - torque_by_rate * rate;
  }
};

struct Model {
  System system;
  std::vector<double> initial;  // states at t = 0, in the system's layout
  bool gamma = false;           // integrate gamma' along with the states
  double radius = 0;            // m
  std::vector<double> stops;    // times in (0, end) at which the input or a derivative jumps, s
  std::optional<Rig> rig{};     // for a RigLoop or CoupledLoop
  std::optional<EventMonitors> events{};  // set if there are events
  std::optional<DryParts> dry{};          // set if something dry switches
  std::vector<double> jumps{};            // the stops at which the reference itself jumps, s
  bool work = true;                       // whether the state motor_work is wanted, if there is one

  // Whether the reference jumps at the instant t, s.
  [[nodiscard]] bool jumps_at(double t) const;
  // The last time before t (s). If the reference jumps at t, a time clearly before the jump,
  // because a sum of times that ends there may be rounded.
  [[nodiscard]] double just_before(double t) const;

  [[nodiscard]] std::size_t size() const { return initial.size(); }
  // The numbers in a row of output besides the states and gamma.
  [[nodiscard]] std::size_t extras() const;
  // The length of a row: the states, r gamma if integrated, and the extras.
  [[nodiscard]] std::size_t row_size() const { return size() + (gamma ? 1 : 0) + extras(); }
  // The place of the ball's spin among the states; -1 if it has none.
  [[nodiscard]] int spin_state() const;
  // Sample::gamma if it is not integrated: 0 if symmetry keeps it zero, otherwise NaN.
  [[nodiscard]] double gamma_not_integrated() const;
  // Converts a row to the paper's symbols.
  [[nodiscard]] Sample sample(double t, const double* row, Detail detail = Detail::all) const;
  // The same for `count` rows without gaps.
  void samples(const double* times, const double* rows, std::size_t count, Detail detail,
               Sample* into) const;
  // Whether the model has switches, samples or events. model/hybrid/hybrid_system.hpp then
  // runs it.
  [[nodiscard]] bool hybrid() const {
    return events.has_value() || dry.has_value() || (rig && (rig->sampled || rig->switches()));
  }
  // The names of the columns from an external controller, in order.
  [[nodiscard]] const std::vector<std::string>& own_columns() const;
  [[nodiscard]] std::vector<std::string> state_names() const;
  [[nodiscard]] bool closed_loop() const;
};

// `reduced`: the smallest system that the scene needs, with one axis if symmetry keeps the ball on
// it. `full`: without these reductions. Motions agree to the tolerance.
enum class Form { reduced, full };

// Builds the system that the scene needs. `integrals`: what output columns need.
[[nodiscard]] Model assemble(const Scenario& scenario, scenario::Integrals integrals,
                             Form form = Form::reduced);

// Index of u = r gamma' among the states, or -1 if symmetry keeps it zero.
template <class AnySystem>
inline constexpr int spin_index = AnySystem::moves == Shape::full ? 4 : -1;

// A part of the physics, and why the model has it or not.
struct Note {
  std::string part, reason;
};

// What the model of a scene, from assemble(), includes and omits, for `bbsim check` and the
// summary.
[[nodiscard]] std::vector<Note> explain(const Scenario& scene, const Model& model);

}  // namespace bbsim::model
