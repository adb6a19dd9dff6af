// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The state of a scene at a time, as a point for linearization.
#pragma once

#include <optional>

#include "model/control/linearize.hpp"
#include "model/model.hpp"
#include "scenario/scenario.hpp"
#include "solve/outcome.hpp"

namespace bbsim::study {

struct PointInTime {
  std::optional<model::LinearPoint> point;  // empty if the run ended before
  solve::Outcome outcome;
};

// Runs the scene up to `time` (s), which must lie within it. `model` is the scene's model.
[[nodiscard]] PointInTime point_in_time(const Scenario& scenario, const model::Model& model,
                                        double time, const solve::Watch& watch);

}  // namespace bbsim::study
