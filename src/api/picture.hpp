// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What a page shows of a run and its scenario.
#pragma once

#include <string>
#include <vector>

#include "file/table_writer.hpp"
#include "record/summary.hpp"
#include "replay/scene.hpp"
#include "scenario/columns.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::api {

// These columns, and after them what a picture of the scene needs and is not among them.
[[nodiscard]] std::vector<const scenario::Column*> with_pictured(
    const std::vector<const scenario::Column*>& columns, const Scenario& scenario);

// A run of the scenario; `end_row` is that of record::Recorder.
[[nodiscard]] replay::Run run_of(const Scenario& scenario, file::TableData rows,
                                 record::RunSummary summary, const std::vector<double>& end_row);

// What is known of a scene: its plate, ball and signals, and what `bbsim check` says of it.
void describe(replay::Run& run, const Scenario& scenario);

// What a file is called in a scene: without its folder.
[[nodiscard]] std::string short_name(const std::string& file);

}  // namespace bbsim::api
