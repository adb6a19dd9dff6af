// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What fits, tuning and designs need of a scenario: its keys, tables, measures and drawn cases.
#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/number_text.hpp"
#include "module.hpp"
#include "record/compare.hpp"
#include "replay/template.hpp"
#include "scenario/columns.hpp"
#include "scenario/edit_text.hpp"
#include "scenario/expectation.hpp"
#include "scenario/keys.hpp"
#include "scenario/log_columns.hpp"
#include "scenario/measures.hpp"
#include "scenario/variation.hpp"
#include "sweep/plan.hpp"
#include "sweep/window.hpp"
#include "yaml/quantity.hpp"

namespace bbsim::python {
namespace {

Scenario scenario_of(const Given& given) {
  return shared_family(given).itself();
}

// Of each axis: the limits of its command, and of its servo's angle and rate.
std::vector<std::array<std::optional<double>, 3>> rig_limits(const Given& given) {
  const Scenario scenario = scenario_of(given);
  std::vector<std::array<std::optional<double>, 3>> limits(2);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    if (scenario.controller) limits[axis][0] = scenario.controller->limit_of(axis);
    if (!scenario.gimbal.servo) continue;
    const Servo& servo = scenario.gimbal.servo_of(axis);
    if (servo.angle_limit < unlimited) limits[axis][1] = servo.angle_limit;
    if (servo.rate_limit < unlimited) limits[axis][2] = servo.rate_limit;
  }
  return limits;
}

std::string edited(const Given& given, const Pairs& pairs, const std::string& comments) {
  std::vector<ScenarioFamily::Setting> settings;
  for (const auto& [key, value] : pairs) settings.push_back({key, value});
  return edited_scenario(shared_family(given).source(), comments, settings);
}

// Why the scenario lacks a column; empty if it has the column.
std::string lacks(const Given& given, const std::string& column) {
  const scenario::Column* const found = scenario::find_column(column);
  if (found == nullptr) return "unknown";
  const auto missing = scenario::missing(*found, scenario_of(given));
  return missing ? missing.why : "";
}

std::string unit_doubt(const std::string& column, double largest) {
  const auto doubt = scenario::doubt_of(largest, column);
  return doubt ? std::string(doubt->looks_like) : "";
}

// For each key of `--vary KEY=SPEC`, its numbers (SI) or texts in all cases.
py::list drawn(const Given& given, const Texts& vary, std::optional<double> samples, double seed) {
  py::list keys;
  if (vary.empty()) return keys;
  const ScenarioFamily& family = shared_family(given);
  Sweep sweep;
  for (const std::string& text : vary) sweep.vary.push_back(scenario::split_variation(text));
  sweep.samples = samples;
  sweep.seed = seed;
  const sweep::SweepPlan plan(family, sweep);
  static_cast<void>(plan.check(family, 0, plan.cases(), [](double) { return true; }));
  for (const auto& [key, numbers, texts] : plan.values()) {
    keys.append(py::make_tuple(key, texts.empty() ? py::cast(numbers) : py::cast(texts)));
  }
  return keys;
}

// The scenario without slips that are only noted, unless a key or a measure refers to them: they
// change no measure, but take a rig out of the lanes of a sweep.
Given without_notes(const Given& given, const Texts& keys, const Texts& measures) {
  const std::string section = "events.slip";
  const auto slip = scenario_of(given).events.slip;
  const bool is_noted = slip && slip->action == OnEvent::note && !slip->sliding;
  const auto refers = [&](const std::string& key) { return key.starts_with(section); };
  if (!is_noted || std::ranges::any_of(keys, refers)) return given;
  Given without = changed(given, {{section, "null"}});
  const Scenario scenario = scenario_of(without);
  for (const std::string& name : measures) {
    const auto measure = scenario::find_measure(name);
    if (!measure || scenario::missing(*measure, scenario)) return given;
  }
  return without;
}

}  // namespace

void define_analysis(py::module_& module, py::class_<Given>& given) {
  using scenario::Expectation;
  using scenario::NamedNumber;
  static constexpr double unlimited = std::numeric_limits<double>::infinity();
  // A key that takes a number: its value (SI) in the scenario, else its default; and its range.
  attributes(
      py::class_<NamedNumber>(module, "KeyFacts"), "name", &NamedNumber::name, "unit",
      &NamedNumber::unit, "value", &NamedNumber::value, "lower",
      [](const NamedNumber& its) {
        const yaml::Range& range = its.key.range;
        return range.above.value_or(range.at_least.value_or(-unlimited));
      },
      "upper", [](const NamedNumber& its) { return its.key.range.at_most.value_or(unlimited); },
      "positive", [](const NamedNumber& its) { return its.key.range.above >= 0.0; });
  attributes(
      py::class_<Expectation>(module, "Expectation"), "text", &Expectation::text, "value",
      &Expectation::value, "measure", [](const Expectation& its) { return its.measure.name; },
      "unit", [](const Expectation& its) { return its.measure.unit(); }, "upper",
      &Expectation::is_upper, "of_loop",
      [](const Expectation& its) { return its.measure.kind == scenario::Measure::Kind::loop; })
      .def("holds", &Expectation::holds);
  given
      .def("key_facts",
           [](const Given& its, const std::string& key) {
             return scenario::number_named("--free", key, shared_family(its));
           })
      .def("value",
           [](const Given& its, const std::string& key) {
             return scenario::number_named("", key, shared_family(its)).value;
           })
      .def("expectation",
           [](const Given& its, const std::string& option, const std::string& text) {
             return scenario::read_expectation(option, text, scenario_of(its));
           })
      .def("measure_name",
           [](const Given& its, const std::string& option, const std::string& name) {
             const auto measure = scenario::measure_named(option, name, scenario_of(its));
             return std::pair(measure.name, measure.unit());
           })
      // The number (SI) that a text such as "2 cm" gives the key; empty if it has no single number.
      .def("number_at",
           [](const Given& its, const std::string& key, const std::string& value) {
             return shared_family(its).number_at(key, {{key, value}});
           })
      .def("text_at",
           [](const Given& its, const std::string& key) { return shared_family(its).text_at(key); })
      .def("has", [](const Given& its,
                     const std::string& key) { return !shared_family(its).text_at(key).empty(); })
      .def("rig_limits", &rig_limits)
      .def("remarks", [](const Given& its) { return scenario_of(its).remarks; })
      .def("begins_anywhere",
           [](const Given& its) { return sweep::begins_anywhere(scenario_of(its)); })
      .def("edited", &edited)
      .def("tables", [](const Given& its) { return scenario_of(its).tables; })
      .def("lacks", &lacks)
      .def("without_notes", &without_notes)
      .def("drawn", &drawn);
  module.def("value_in", &yaml::value_in);
  // Of a text such as "KEY,-KEY,2*KEY": the keys, and their factors.
  module.def("tied_keys", [](const std::string& keys) {
    std::vector<std::pair<std::string, double>> all;
    for (const auto& its : scenario::tied_keys({keys, ""})) all.emplace_back(its.path, its.factor);
    return all;
  });
  module.def("unit_doubt", &unit_doubt);
  module.def("filled_page",
             [](const std::string& name, const std::string& title, const std::string& json) {
               return replay::filled(replay::read_template(name), title, json);
             });
  module.def("file_of_template", &replay::file_of_template);
  module.def("aligned", &record::aligned);
  module.def("short_number", &short_number);
  module.def("rounded", &rounded);
}

}  // namespace bbsim::python
