// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/place_log.hpp"

#include <algorithm>

#include "api/measure.hpp"
#include "base/error.hpp"
#include "record/log_distance.hpp"

namespace bbsim::api {
namespace {

file::TableData table_of(const replay::Run& run) {
  file::TableData table;
  for (const replay::Series& column : run.columns) {
    table.names.push_back(column.name);
    table.columns.push_back(column.values);
  }
  return table;
}

bool have_in_common(const replay::Run& log, const replay::Run& run) {
  return std::ranges::any_of(log.columns, [&](const replay::Series& column) {
    return column.name != "t" && replay::find_series(run, column.name) != nullptr;
  });
}

}  // namespace

std::vector<std::string> place_log(replay::Scene& scene, bool align) {
  replay::Run& log = scene.runs.back();
  const replay::Run& first_run = scene.runs.front();
  std::vector<std::string> notes;
  file::TableData log_table = table_of(log);
  const file::TableData run_table = table_of(first_run);
  const auto t = std::ranges::find(log.columns, "t", &replay::Series::name);
  if (align) {
    const double offset = record::time_offset(log_table, log.name, run_table, first_run.name);
    for (double& time : t->values) time += offset;
    log_table = table_of(log);
    notes.push_back(moved_text(log.name, offset));
  }
  if (t == log.columns.end() || !have_in_common(log, first_run)) return notes;
  try {
    notes.push_back(
        record::to_text(record::log_distance(log_table, log.name, run_table, first_run.name),
                        log.name, first_run.name));
    notes.back().pop_back();
  } catch (const InputError& error) {  // no time in common; the log can still be shown
    notes.push_back("warning: " + std::string(error.what()));
  }
  return notes;
}

}  // namespace bbsim::api
