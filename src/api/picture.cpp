// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/picture.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "api/check.hpp"
#include "base/text.hpp"
#include "replay/sources.hpp"

namespace bbsim::api {

std::vector<const scenario::Column*> with_pictured(
    const std::vector<const scenario::Column*>& columns, const Scenario& scenario) {
  std::vector<std::string> names{"t",       "x",       "y",       "phi",    "theta",
                                 "ball_qw", "ball_qx", "ball_qy", "ball_qz"};
  if (scenario.controller) {
    for (const char* name : {"x_reference", "y_reference", "phi_command", "theta_command"}) {
      names.emplace_back(name);
    }
    if (scenario.controller->sampling) {
      names.emplace_back("x_measured");
      names.emplace_back("y_measured");
    }
  }
  std::vector<const scenario::Column*> all = columns;
  for (const scenario::Column* column : scenario::columns_named(names)) {
    if (std::ranges::find(all, column) == all.end()) all.push_back(column);
  }
  return all;
}

replay::Run run_of(const Scenario& scenario, file::TableData rows, record::RunSummary summary,
                   const std::vector<double>& end_row, bool checked) {
  for (std::size_t c = 0; c < end_row.size(); ++c) rows.columns[c].push_back(end_row[c]);
  replay::Run run = replay::run_of_table(std::move(rows), short_name(scenario.source.file));
  run.has_end_row = !end_row.empty();
  run.reached = summary.end_time;
  api::describe(run, scenario, checked);
  run.status = summary.status;
  run.reason = summary.reason;
  run.version = summary.version;
  for (const record::EventRecord& event : summary.events) {
    run.events.push_back({event.t, event.name, event.action, event.x, event.y});
  }
  summary.scenario_text.clear();  // replay::Run holds it separately
  run.summary = record::to_json(summary);
  return run;
}

void describe(replay::Run& run, const Scenario& scenario, bool checked) {
  replay::describe(run, scenario);
  if (checked) run.check = lines_of(to_text(describe(scenario)));
}

std::string short_name(const std::string& file) {
  return file == "-" ? "standard input" : std::filesystem::path(file).filename().string();
}

}  // namespace bbsim::api
