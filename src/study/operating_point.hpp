// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The point of a scene's motion at a time, to linearize it about.
#pragma once

#include <optional>

#include "model/control/linearize.hpp"
#include "model/model.hpp"
#include "scenario/scenario.hpp"
#include "solve/outcome.hpp"

namespace bbsim::study {

struct PointInTime {
  std::optional<model::LinearPoint> point;  // none if the run ended before
  solve::Outcome outcome;
};

// Runs the scene, of which `model` is the model, up to `time` (s), which is within it.
[[nodiscard]] PointInTime point_in_time(const Scenario& scenario, const model::Model& model,
                                        double time, const solve::Watch& watch);

}  // namespace bbsim::study
