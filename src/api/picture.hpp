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

// These columns, followed by others that a picture of the scene needs.
[[nodiscard]] std::vector<const scenario::Column*> with_pictured(
    const std::vector<const scenario::Column*>& columns, const Scenario& scenario);

// Run of the scenario for a page; `end_row` is that of record::Recorder.
[[nodiscard]] replay::Run run_of(const Scenario& scenario, file::TableData rows,
                                 record::RunSummary summary, const std::vector<double>& end_row,
                                 bool checked);

// Adds facts about the scene: its plate, ball and signals, and, if `checked`, the report of
// `bbsim check`.
void describe(replay::Run& run, const Scenario& scenario, bool checked = true);

// Name of a file without its folder, as scenes show it.
[[nodiscard]] std::string short_name(const std::string& file);

}  // namespace bbsim::api
