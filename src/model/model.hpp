// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Scenario -> Model: the smallest system that gives the scene's answer.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/events/event_monitors.hpp"
#include "model/systems/list.hpp"
#include "model/systems/rig.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::model {

// What switches in a coupled scene beside its servos and samples.
struct DryParts {
  bool rolling = false, pivoting = false;  // rolling resistance, pivoting friction
  bool slides = false;
  double static_friction = 0;       // beyond which it does
  double friction = 0;              // of the motors, N m
  double torque_limit = unlimited;  // of a motor, N m
  bool integrates = false;          // its position loop
  // A voltage at its limit gives stall_torque - torque_by_rate rate one way; infinite without one.
  double stall_torque = unlimited, torque_by_rate = 0;  // N m, N m s
  std::optional<OnEvent> rest{}, stick{};               // whether they are events

  [[nodiscard]] bool limits_torque() const {
    return torque_limit < unlimited || stall_torque < unlimited;
  }
  [[nodiscard]] bool switches() const {
    return rolling || pivoting || slides || friction > 0 || limits_torque();
  }
  // The most torque that the voltage gives in a direction, 1 or -1, at a rate.
  [[nodiscard]] double by_voltage(double sign, double rate) const {
    return sign * stall_torque - torque_by_rate * rate;
  }
};

struct Model {
  System system;
  std::vector<double> initial;  // states at t = 0, as the system packs them
  bool gamma = false;           // integrate gamma' beside the states
  double radius = 0;            // m
  std::vector<double> stops;    // times in (0, end) at which a derivative of the input jumps, s
  std::optional<Rig> rig{};     // of a RigLoop
  std::optional<EventMonitors> events{};  // there if something is
  std::optional<DryParts> dry{};          // there if something of it switches

  [[nodiscard]] std::size_t size() const { return initial.size(); }
  // Numbers in a row of output beside the states and gamma.
  [[nodiscard]] std::size_t extras() const;
  // Length of a row: the states; r gamma, if it is integrated; the extras.
  [[nodiscard]] std::size_t row_size() const { return size() + (gamma ? 1 : 0) + extras(); }
  // Sample::gamma of a row that does not have it: 0 where symmetry keeps it so, otherwise no
  // number.
  [[nodiscard]] double gamma_not_integrated() const;
  // A row in the paper's symbols.
  [[nodiscard]] Sample sample(double t, const double* row, Detail detail = Detail::all) const;
  // Whether anything switches, samples or is watched for: model/hybrid_system.hpp runs it then.
  [[nodiscard]] bool hybrid() const {
    return events.has_value() || dry.has_value() || (rig && (rig->sampled || rig->switches()));
  }
  // The names of the numbers that one's own controller gives for columns, in their order.
  [[nodiscard]] const std::vector<std::string>& own_columns() const;
  [[nodiscard]] std::vector<std::string> state_names() const;
  [[nodiscard]] bool closed_loop() const;
};

// Whether a ball that symmetry keeps on an axis of the plane is modelled along that axis alone, or
// as one that may go anywhere: the answers are the same, and one of many scenes may be like the
// others.
enum class Symmetry { used, ignored };

// Builds what the scene needs. `gamma` says whether an output column asks for that angle.
[[nodiscard]] Model assemble(const Scenario& scenario, bool gamma,
                             Symmetry symmetry = Symmetry::used);

// Index of u = r gamma' among the states, or -1 where symmetry keeps it zero.
template <class AnySystem>
inline constexpr int spin_index = AnySystem::moves == Shape::full ? 4 : -1;

}  // namespace bbsim::model
