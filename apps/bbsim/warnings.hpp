// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What a run that came to its end may still not have done as its user meant.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/model.hpp"
#include "record/edge_note.hpp"

namespace bbsim::app {

// The scenario's remarks; an unstable closed loop, unless the run `failed`, whose reason tells it;
// and where the ball left a plate whose edge nobody watches.
[[nodiscard]] std::vector<std::string> warnings_of(const Scenario& scenario,
                                                   const model::Model& model, bool failed,
                                                   const std::optional<record::OffPlate>& left);

}  // namespace bbsim::app
