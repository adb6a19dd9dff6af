// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A run for a live page: with measures, and the tasks of the scenario's exercise.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>
#include <utility>

#include "api/check.hpp"
#include "api/replay.hpp"
#include "base/error.hpp"
#include "base/number_text.hpp"
#include "model/control/linearize.hpp"
#include "scenario/keys.hpp"
#include "scenario/measures.hpp"
#include "scenario/variation.hpp"

namespace bbsim::api {
namespace {

using replay::LiveKey;

std::vector<LiveKey> keys_of(const ScenarioFamily& family) {
  std::vector<LiveKey> keys;
  for (const std::string& path : scenario::key_paths()) {
    const auto number = scenario::number_key(path);
    if (!number) continue;
    const std::optional<double> value = family.number_at(path, {});
    if (!value) continue;
    const yaml::Range& range = number->range;
    std::string text = family.text_at(path);
    const std::string unit{family.unit_of(path, {})};
    if (text.empty()) {  // an item of a list
      text = number_text(*value) + ' ' + unit;
    }
    keys.push_back({path, text, unit, *value, range.at_least ? range.at_least : range.above,
                    range.at_most, !range.at_least && range.above, number->whole, number->meaning});
  }
  return keys;
}

std::vector<Variation> drawn_keys(const Sweep& sweep) {
  std::vector<Variation> drawn;
  std::ranges::copy_if(sweep.vary, std::back_inserter(drawn), [](const Variation& variation) {
    return scenario::parse_variation(variation).random();
  });
  return drawn;
}

bool is_of_rig(const LiveKey& key) {
  constexpr std::string_view others[] = {
      "time.", "output.", "solver.", "sweep.", "exercise.", "controller.reference.", "events."};
  return !key.whole && key.value != 0 &&
         std::ranges::none_of(others, [&](auto part) { return key.key.starts_with(part); });
}

// Draws each number within 10 % of its value, as far as it is allowed.
std::vector<Variation> tolerances(const ScenarioFamily& family) {
  const auto exercise = scenario::checked_exercise(family.itself());
  std::vector<Variation> vary;
  for (const LiveKey& key : keys_of(family)) {
    const bool is_free = !exercise || exercise->free.empty() ||
                         std::ranges::find(exercise->free, key.key) != exercise->free.end();
    if (!is_free || !is_of_rig(key)) continue;
    const double away = 0.1 * std::abs(key.value);
    const double low = std::max(key.value - away, key.least.value_or(-INFINITY));
    const double high = std::min(key.value + away, key.most.value_or(INFINITY));
    const auto text = [&](double value) {
      return number_text(value) + (key.unit.empty() ? "" : ' ' + key.unit);
    };
    if (low < high) vary.push_back({key.key, "uniform:" + text(low) + ':' + text(high)});
  }
  return vary;
}

// Of a ball that a controller leads to a point, along the axes on which it does not start there.
std::vector<std::string> step_metrics(const Scenario& scenario) {
  std::vector<std::string> names;
  if (!scenario.controller) return names;
  const auto* const point = std::get_if<PointReference>(&scenario.controller->reference);
  for (const std::size_t axis : {0U, 1U}) {
    if (point == nullptr || scenario.ball.position[axis] == point->position[axis]) continue;
    for (const char* const metric : {"RiseTime", "Overshoot", "SettlingTime"}) {
      names.push_back((axis == 0 ? "x." : "y.") + std::string(metric));
    }
  }
  return names;
}

}  // namespace

LiveRun::LiveRun(RunRequest& request) : source_(request.scenario.source) {
  const Scenario& scenario = request.scenario;
  request.pictured = true;
  const bool closed_loop = scenario.controller && commands_of(scenario) == nullptr;
  request.measures = scenario::default_measures(closed_loop);
  if (request.checked) {
    std::vector<std::string> more = step_metrics(scenario);
    std::ranges::copy(scenario.sweep.measure, std::back_inserter(more));
    for (std::string& name : more) {
      if (std::ranges::find(request.measures, name) != request.measures.end()) continue;
      request.measures.push_back(std::move(name));
    }
  }
  if (auto exercise = scenario::checked_exercise(scenario)) exercise_ = std::move(*exercise);
  for (const auto& task : exercise_.tasks) request.expect.push_back(task.expect);
}

replay::Live LiveRun::of(const RunResult& result, bool with_keys) const {
  replay::Live live;
  if (with_keys) live.keys = keys_of(ScenarioFamily(source_));
  live.free = exercise_.free;
  for (std::size_t i = 0; i < exercise_.tasks.size(); ++i) {
    const auto& [text, expect] = exercise_.tasks[i];
    live.tasks.push_back({text, expect, result.summary.expectations[i].holds});
  }
  for (const auto& [name, value] : result.summary.measures) {
    live.measures.push_back({name, scenario::find_measure(name)->unit(), value});
  }
  return live;
}

std::optional<replay::Live::Loops> loops_of(const Scenario& scenario) {
  Watch nobody;
  try {
    const Linearization linearization =
        linearize({scenario, LinearKind::loop}, nobody).linearization;
    if (linearization.margins.empty()) return {};
    model::OpenLoops open = model::open_loops(linearization);
    replay::Live::Loops loops{linearization.system.period,
                              std::move(open.frequencies),
                              {},
                              record::margins_json(linearization),
                              linearization.stable};
    for (std::size_t i = 0; i < open.curves.size(); ++i) {
      loops.curves.push_back({linearization.margins[i].command, std::move(open.curves[i].gain),
                              std::move(open.curves[i].phase)});
    }
    return loops;
  } catch (const InputError&) {  // an open loop, or one that is not linear
    return {};
  }
}

std::vector<sweep::SweepPlan::ListedKey> drawn_rigs(const ScenarioFamily& family,
                                                    std::size_t count) {
  const Sweep own = family.read_sweep();
  Sweep sweep;
  sweep.vary = drawn_keys(own);
  if (sweep.vary.empty()) sweep.vary = tolerances(family);
  if (sweep.vary.empty()) {
    throw InputError("rigs: the scenario has no numbers to draw; allowed: keys with a number, or " +
                     std::string("drawn keys in sweep.vary, such as uniform:1.8 cm:2.2 cm"));
  }
  sweep.samples = static_cast<double>(count);
  sweep.seed = own.seed;
  return sweep::SweepPlan(family, sweep).values();
}

}  // namespace bbsim::api
