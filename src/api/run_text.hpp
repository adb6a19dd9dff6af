// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Sentences about a run: why it ended early, what it noted, what may not be as the user meant it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/model.hpp"
#include "record/edge_note.hpp"
#include "solve/outcome.hpp"

namespace bbsim::api {

// Why a run failed: when, what the integrator said, what grew, and what to do.
[[nodiscard]] std::string failure_text(const Scenario& scenario, const model::Model& model,
                                       const solve::Outcome& outcome);

// Why a run stopped: when, at what, which key says so, and how the scene would run on.
[[nodiscard]] std::string stopped_text(const Scenario& scenario, const solve::Outcome& outcome);

// How often each thing was noted, and when first; a line each, empty if nothing was.
[[nodiscard]] std::string noted_text(const std::vector<model::Occurrence>& occurrences);

// Remarks on the scenario, an unstable loop, and a ball that left its plate unwatched.
[[nodiscard]] std::vector<std::string> warnings_of(const Scenario& scenario,
                                                   const model::Model& model, bool failed,
                                                   const std::optional<record::OffPlate>& left);

}  // namespace bbsim::api
