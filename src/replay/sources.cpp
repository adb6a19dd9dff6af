// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "replay/sources.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include "model/control/sample_times.hpp"
#include "model/model.hpp"
#include "model/signals/signal_pair.hpp"
#include "model/spectrum.hpp"
#include "scenario/columns.hpp"
#include "scenario/measures.hpp"

namespace bbsim::replay {
namespace {

constexpr std::array<std::string_view, 4> orientation_columns = {"ball_qw", "ball_qx", "ball_qy",
                                                                 "ball_qz"};

// One lap of a circle, one period of a square wave, otherwise the whole scene.
double duration_of(const Reference& reference, double end) {
  if (const auto* square = std::get_if<SquareReference>(&reference)) {
    return std::min(end, square->period);
  }
  const auto* circle = std::get_if<CircleReference>(&reference);
  if (circle == nullptr || circle->rate == 0) return end;
  return std::min(end, 2 * std::numbers::pi / std::abs(circle->rate));
}

std::vector<std::array<double, 2>> path_of(const Reference& reference, double end) {
  if (std::holds_alternative<CommandProfiles>(reference)) return {};
  const model::SignalPair signals = model::reference_path(reference, end);
  const auto point = [&](double t) {
    const auto jets = signals.at(t);
    return std::array<double, 2>{jets[0].value, jets[1].value};
  };
  if (std::holds_alternative<PointReference>(reference)) return {point(0)};
  constexpr int pieces = 1500;
  std::vector<std::array<double, 2>> path;
  for (int i = 0; i <= pieces; ++i) path.push_back(point(duration_of(reference, end) * i / pieces));
  return path;
}

std::optional<Poles> poles_of(const model::Model& model) {
  if (!model.closed_loop()) return {};
  if (model.rig && model.rig->sampled && !model::feeds_back(model.rig->sampled->law.kind)) {
    return {};  // only the controller could know them
  }
  if (model.rig && model.rig->sampled) {
    const model::SampledLoop& loop = *model.rig->sampled;
    const double samples = model::common_cycle(loop.sampling, loop.sensor).samples;
    return Poles{model::sampled_poles(model), loop.sampling.period * samples};
  }
  return Poles{model::closed_loop_poles(model), {}};
}

// Leaves the columns of numbers, with the units of `bbsim columns`.
void leave_numbers(Run& run) {
  run.take_texts();
  for (file::Column& column : run.columns) {
    const scenario::Column* const known = scenario::find_column(column.name);
    if (known != nullptr && column.unit.empty() && run.units_known) column.unit = known->unit;
  }
}

// Rolls the ball from the last row to the instant at which an event stopped the run.
void turn_to_the_end(Run& run) {
  if (!run.has_end_row || !run.rolls || run.orientation.size() < 2) return;
  const std::vector<double> x = coordinate(run, "x"), y = coordinate(run, "y");
  const std::size_t end = x.size() - 1;
  run.orientation[end] = product(
      rolled({x[end - 1], x[end]}, {y[end - 1], y[end]}, nullptr, run.scenario->ball.radius).back(),
      run.orientation[end - 1]);
}

// If all four parts of the ball's orientation are recorded, makes them the run's orientation and
// removes their columns. A row without a finite orientation repeats the last one.
void take_orientation(Run& run) {
  std::array<const file::Column*, 4> parts{};
  for (std::size_t part = 0; part < parts.size(); ++part) {
    parts[part] = run.find(orientation_columns[part]);
    if (parts[part] == nullptr) return;
  }
  Quaternion last{1, 0, 0, 0};
  for (std::size_t row = 0; row < parts[0]->numbers.size(); ++row) {
    const Quaternion now = normalised({parts[0]->numbers[row], parts[1]->numbers[row],
                                       parts[2]->numbers[row], parts[3]->numbers[row]});
    if (std::isfinite(now[0] + now[1] + now[2] + now[3])) last = now;
    run.orientation.push_back(last);
  }
  std::erase_if(run.columns, [](const file::Column& series) {
    return std::ranges::find(orientation_columns, series.name) != orientation_columns.end();
  });
}

SweepColumn sweep_column(results::Column column) {
  if (!column.is_text()) column.texts.clear();
  for (std::size_t i = 0; i < column.texts.size(); ++i) column.texts[i] = column.text(i);
  return {std::move(column)};
}

// Notes whether the key was drawn, or is tied to another one.
void relate(SweepColumn& key, const results::SweepTable& table) {
  const auto of = std::ranges::find(table.keys, key.name, &results::Key::name);
  if (of == table.keys.end()) return;
  key.drawn = of->drawn;
  const std::string& leader = table.keys[of->leader].name;
  if (leader != key.name) key.along = leader;
}

}  // namespace

Run run_of_table(file::Table table, const std::string& name) {
  Run run;
  run.name = name;
  run.columns = std::move(table.columns);
  leave_numbers(run);
  take_orientation(run);
  return run;
}

void describe_sight(Run& run, const Scenario& scenario) {
  run.title = scenario.title;
  run.scenario = scenario;
  if (scenario.events.slip && scenario.events.slip->sliding) run.rolls = false;
  // `bbsim columns` lists commands as angles; their unit is that of the gimbal's drive.
  for (file::Column& series : run.columns) {
    if (scenario.controller && scenario::is_command(series.name)) {
      series.unit = command_unit(scenario.controller->drives);
    }
  }
  turn_to_the_end(run);
}

void describe(Run& run, const Scenario& scenario) {
  describe_sight(run, scenario);
  if (scenario.controller) {
    run.reference = path_of(scenario.controller->reference, scenario.time.end);
  }
  run.poles = poles_of(model::assemble(scenario, false));
}

Run run_of_result(results::Result result, const std::string& name) {
  results::add_end_row(result);
  Run run{std::move(result), name};
  // The run must also say how the ball pivots. On a beam it does not pivot.
  run.rolls = run.scenario && (run.find("gamma") != nullptr || run.find("spin") != nullptr ||
                               run.find("x") == nullptr || run.find("y") == nullptr);
  run.scenario.reset();
  leave_numbers(run);
  take_orientation(run);
  return run;
}

Sweep sweep_of_result(results::Result result, const std::string& name) {
  Sweep sweep;
  sweep.name = name;
  sweep.title = std::move(result.title);
  if (result.scenario) sweep.source = result.scenario->source;
  const results::SweepTable table = results::sweep_table(result);
  const results::Column* const reason = result.find("reason");
  bool before_status = true;
  for (results::Column& column : result.columns) {
    if (column.name == "case") {
      sweep.cases = std::move(column.numbers);
    } else if (column.name == "status") {
      before_status = false;
      sweep.status = std::move(column.texts);
    } else if (before_status) {
      sweep.keys.push_back(sweep_column(column));
      relate(sweep.keys.back(), table);
    } else if (column.name != "reason") {
      sweep.measures.push_back(sweep_column(column));
      SweepColumn& measure = sweep.measures.back();
      const auto known = scenario::find_measure(measure.name);
      if (measure.unit.empty() && known) measure.unit = known->unit();
      if (measure.unit.empty() && measure.name == "end_time") measure.unit = "s";
    }
  }
  const std::size_t reasons = reason == nullptr ? 0 : reason->texts.size();
  for (std::size_t i = 0; i < std::min(reasons, sweep.status.size()); ++i) {
    if (!reason->texts[i].empty()) sweep.status[i] += ": " + reason->texts[i];
  }
  // Measures of interest come first; the end time is known for most cases.
  std::stable_partition(sweep.measures.begin(), sweep.measures.end(),
                        [](const SweepColumn& measure) { return measure.name != "end_time"; });
  return sweep;
}

}  // namespace bbsim::replay
