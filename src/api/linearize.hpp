// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A scene as a linear system: A, B, C, D, poles, zeros and margins.
#pragma once

#include <optional>
#include <string>

#include "api/check.hpp"
#include "api/watch.hpp"
#include "base/error.hpp"
#include "model/control/linearize.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::api {

using model::Linearization;
using model::LinearKind;

// plant, loop or sampled; nothing for an empty name. Throws InputError for another one.
[[nodiscard]] std::optional<LinearKind> kind_named(const std::string& name);

struct LinearizeRequest {
  Scenario scenario;
  std::optional<LinearKind> kind{};  // without one, what is usual for the scene
  std::string at = "home";           // or equilibrium, or a time of the run, such as "2 s"
};

struct Linearized {
  ExitCode code = ExitCode::done;
  std::string reason;  // why there is no linear system; empty if there is one
  std::string note;    // what it leaves out
  std::string scenario, kind, at;
  Linearization linearisation;
};

// Throws InputError where the scene has no such linear system.
[[nodiscard]] Linearized linearize(const LinearizeRequest& request, Watch& watch);

// Margins of each command's loop, and the bandwidths.
[[nodiscard]] Report margin_lines(const Linearization& made);

// Points of operation, names and units, poles, zeros and margins.
[[nodiscard]] Report report_of(const Linearized& made);

// As a file of that name is written, by its ending: .m, .py, .csv, or else JSON.
[[nodiscard]] std::string file_text(const Linearized& made, const std::string& file);

}  // namespace bbsim::api
