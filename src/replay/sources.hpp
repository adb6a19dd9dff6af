// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Where scenes come from: scenarios, tables of rows, results of runs and of sweeps.
#pragma once

#include <string>

#include "file/table_writer.hpp"
#include "plot/result.hpp"
#include "replay/scene.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::replay {

// A table's columns, with unit and meaning where `bbsim columns` knows them. Without x or y, as a
// beam may be written, the ball stays on the other axis. Columns ball_qw to ball_qz become the
// run's orientation.
[[nodiscard]] Run run_of_table(file::TableData table, const std::string& name);

// Makes a run of a result in the same way, with what its file or its summary tells; its scenario is
// left to describe(). Columns of texts are left out.
[[nodiscard]] Run run_of_result(plot::Result result, const std::string& name);

// A result of `bbsim sweep` (plot::Result::is_sweep()).
[[nodiscard]] Sweep sweep_of_result(plot::Result result, const std::string& name);

// What the scenario says of a run: title, text, plate, ball, mounting, reference path, poles.
// Throws KeyError where the loop cannot be assembled.
void describe(Run& run, const Scenario& scenario);

// Describes only what needs neither the scenario's tables nor a loop: no path and no poles.
void describe_sight(Run& run, const Scenario& scenario);

}  // namespace bbsim::replay
