// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "fit/window_run.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.hpp"
#include "model/model.hpp"
#include "record/rows.hpp"
#include "solve/integrate.hpp"
#include "sweep/case_times.hpp"

namespace bbsim::fit {

Scenario prepared(Scenario scenario) {
  sweep::remove_events(scenario);
  scenario.solver.error.reset();
  scenario.solver.rtol = std::min(scenario.solver.rtol, 1e-10);
  scenario.solver.atol = std::min(scenario.solver.atol, 1e-12);
  scenario.source = {};  // each run copies the scenario
  scenario.remarks.clear();
  return scenario;
}

std::vector<double> run_window(const Scenario& scene, const Start& start,
                               const std::vector<double>& times,
                               const std::vector<const scenario::Column*>& columns,
                               std::string& why) {
  Scenario begun = scene;
  sweep::set_start(begun, start);
  std::optional<model::Model> assembled;
  try {
    assembled = model::assemble(begun, scenario::integrals_for(columns));
  } catch (const InputError& error) {
    why = error.what();
    return {};
  }
  const model::Model& model = *assembled;
  constexpr double shortest = 1e-9;  // s; a delay may move all times to the start
  const sweep::TimedRows timed = sweep::rows_at(times, 0, std::max(times.back(), shortest));
  solve::Trajectory reached(model.row_size());
  const solve::Outcome outcome = solve::integrate(
      model, begun.solver.method, {begun.solver.rtol, begun.solver.atol}, timed.grid, reached);
  if (outcome.ending != solve::Ending::done) {
    why = outcome.reason.empty() ? "the run does not reach the window's end" : outcome.reason;
    return {};
  }
  const model::BallConstants constants = model::constants_of(begun);
  std::vector<double> at(timed.grid.size());
  for (std::size_t i = 0; i < at.size(); ++i) at[i] = timed.grid[i];
  record::Rows rows(columns);
  rows.begin(model, constants);
  rows.evaluate(at.data(), reached.row(0), at.size());
  std::vector<std::vector<double>> by_column(columns.size(), std::vector<double>(times.size()));
  std::vector<const double*> found;
  for (std::size_t c = 0; c < columns.size(); ++c) found.push_back(rows[c]);
  sweep::SeriesWriter(by_column, 0, &timed).append(found, at.size());
  std::vector<double> values;
  for (const std::vector<double>& column : by_column) {
    values.insert(values.end(), column.begin(), column.end());
  }
  if (!std::ranges::all_of(values, [](double value) { return std::isfinite(value); })) {
    why = "the motion is beyond the range of doubles";
    return {};
  }
  return values;
}

}  // namespace bbsim::fit
