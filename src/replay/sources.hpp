// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Makes scenes from scenarios, tables of rows, and results of runs and sweeps.
#pragma once

#include <string>

#include "file/table.hpp"
#include "replay/scene.hpp"
#include "results/result.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::replay {

// A run with the columns of a table. Units and meanings come from `bbsim columns`, if it knows the
// column. Without x or y, as on a beam, the ball stays on the other axis. Columns ball_qw to
// ball_qz become the run's orientation.
[[nodiscard]] Run run_of_table(file::Table table, const std::string& name);

// Makes a run of a result in the same way, with the content of its file or summary. Does not use
// the result's scenario; describe() does. Leaves out columns of texts.
[[nodiscard]] Run run_of_result(results::Result result, const std::string& name);

// Makes a sweep of a result of `bbsim sweep` (results::Result::is_sweep()).
[[nodiscard]] Sweep sweep_of_result(results::Result result, const std::string& name);

// Adds the scenario's part of a run: title, text, plate, ball, mounting, reference path, poles.
// Throws KeyError if the loop cannot be assembled.
void describe(Run& run, const Scenario& scenario);

// Adds only the parts that need neither the scenario's tables nor a loop: no path and no poles.
void describe_sight(Run& run, const Scenario& scenario);

}  // namespace bbsim::replay
