// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The events of a run, as margins that fall through zero.
#pragma once

#include <vector>

#include "model/ball/dynamics.hpp"
#include "model/sample.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::model {

// An event, which occurs when its margin falls through zero.
struct Monitor {
  enum class Kind { edge, slip, lift_off, tilt, singularity, dead_point };
  Kind kind;
  OnEvent action;
  double scale;      // of its margin
  double limit = 0;  // friction coefficient, angle, or distance

  [[nodiscard]] const char* name() const;
};

// All events of a scene.
struct EventMonitors {
  std::vector<Monitor> monitors;
  Plate plate;
  BallConstants constants;

  // Writes each monitor's margin, negative beyond the event.
  void margins(const Sample& sample, double* values) const;

  [[nodiscard]] double edge_margin(const Sample& sample) const;
};

// The events of the scenario and those that the model requires, such as dead points of a linkage.
[[nodiscard]] EventMonitors event_monitors(const Scenario& scene);

}  // namespace bbsim::model
