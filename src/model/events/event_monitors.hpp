// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The events of a run, as margins that fall through zero.
#pragma once

#include <vector>

#include "model/ball/dynamics.hpp"
#include "model/sample.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::model {

// Something that is watched: `margin` falls through zero when it happens.
struct Monitor {
  enum class Kind { edge, slip, lift_off, tilt, singularity, dead_point };
  Kind kind;
  OnEvent action;
  double limit = 0;  // friction coefficient, angle, or distance

  [[nodiscard]] const char* name() const;
};

// All that a run is watched for.
struct EventMonitors {
  std::vector<Monitor> monitors;
  Plate plate;
  BallConstants constants;

  // The size of each monitor's quantity: appends one of each.
  void append_scales(std::vector<double>& scales) const;

  // Tells how far each monitor is from happening: negative once it does.
  void margins(const Sample& sample, double* values) const;

 private:
  [[nodiscard]] double edge_margin(const Sample& sample) const;
};

// Those that the scene asks for, and those that it has to have. A linkage that has dead points is
// watched for them.
[[nodiscard]] EventMonitors event_monitors(const Scenario& scene);

}  // namespace bbsim::model
