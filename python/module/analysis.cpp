// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "analysis.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/short_number.hpp"
#include "replay/template.hpp"
#include "results/log.hpp"
#include "scenario/columns.hpp"
#include "scenario/edit_text.hpp"
#include "scenario/expectation.hpp"
#include "scenario/key_value.hpp"
#include "scenario/measures.hpp"
#include "scenario/reader.hpp"
#include "scenario/unit_doubts.hpp"
#include "scenario/value_in.hpp"
#include "scenario/variation.hpp"
#include "sweep/plan.hpp"
#include "sweep/window.hpp"

namespace bbsim::python {
namespace {

using Pairs = std::vector<std::pair<std::string, std::string>>;
using Setting = ScenarioFamily::Setting;
using ListedKey = sweep::SweepPlan::ListedKey;

constexpr double unlimited = std::numeric_limits<double>::infinity();

std::vector<Setting> settings_of(const Pairs& pairs) {
  std::vector<Setting> settings;
  for (const auto& [key, value] : pairs) settings.push_back({key, value});
  return settings;
}

void define_keys(py::module_& module) {
  using scenario::NamedNumber;
  py::class_<NamedNumber>(module, "KeyFacts")
      .def_readonly("name", &NamedNumber::name)
      .def_readonly("unit", &NamedNumber::unit)
      .def_readonly("value", &NamedNumber::value)
      .def_property_readonly("lower",
                             [](const NamedNumber& its) {
                               const yaml::Range& range = its.key.range;
                               return range.above.value_or(range.at_least.value_or(-unlimited));
                             })
      .def_property_readonly(
          "upper", [](const NamedNumber& its) { return its.key.range.at_most.value_or(unlimited); })
      .def_property_readonly("positive",
                             [](const NamedNumber& its) { return its.key.range.above >= 0.0; });
  module.def(
      "key_facts",
      [](const Given& given, const std::string& option, const std::string& key) {
        return scenario::number_named(option, key, shared_family(given));
      },
      py::arg("given"), py::arg("option"), py::arg("key"));
  module.def("value_in", &scenario::value_in, py::arg("text"), py::arg("unit"));
  module.def(
      "text_at",
      [](const Given& given, const std::string& key) { return shared_family(given).text_at(key); },
      py::arg("given"), py::arg("key"));
  module.def(
      "has",
      [](const Given& given, const std::string& key) {
        return !shared_family(given).text_at(key).empty();
      },
      py::arg("given"), py::arg("key"));
  module.def(
      "rig_limits",
      [](const Given& given) {
        const Scenario scenario = shared_family(given).read({});
        using Limit = std::optional<double>;
        std::vector<std::array<Limit, 3>> limits(2);
        for (std::size_t axis = 0; axis < 2; ++axis) {
          if (scenario.controller) limits[axis][0] = scenario.controller->limit_of(axis);
          if (!scenario.gimbal.servo) continue;
          limits[axis][1] = scenario.gimbal.servo_of(axis).angle_limit;
          limits[axis][2] = scenario.gimbal.servo_of(axis).rate_limit;
        }
        return limits;
      },
      py::arg("given"));
  module.def(
      "remarks", [](const Given& given) { return shared_family(given).read({}).remarks; },
      py::arg("given"));
  module.def(
      "begins_anywhere",
      [](const Given& given) { return sweep::begins_anywhere(shared_family(given).read({})); },
      py::arg("given"));
  module.def(
      "edited",
      [](const Given& given, const Pairs& settings, const std::string& comments, bool reads) {
        const Source& source = shared_family(given).source();
        std::string text = edited_scenario(source, comments, settings_of(settings));
        if (reads) static_cast<void>(ScenarioFamily(Source{source.file, text, {}}).read({}));
        return text;
      },
      py::arg("given"), py::arg("settings"), py::arg("comments"), py::arg("reads"));
  module.def(
      "tables",
      [](const Given& given) {
        Scenario scenario = shared_family(given).read({});
        scenario.source = shared_family(given).source();
        Pairs files;
        for (const TableFile& table : table_files(scenario)) {
          files.emplace_back(table.key, table.path);
        }
        return files;
      },
      py::arg("given"));
}

void define_columns(py::module_& module) {
  module.def(
      "lacks",
      [](const Given& given, const std::string& column) -> std::pair<std::string, std::string> {
        const scenario::Column* const found = scenario::find_column(column);
        if (found == nullptr) return {"unknown", "the names that `bbsim columns` lists"};
        const auto missing = scenario::missing(*found, shared_family(given).read({}));
        if (!missing) return {};
        return {missing.why, missing.instead};
      },
      py::arg("given"), py::arg("column"));
  module.def(
      "unit_doubt",
      [](const std::string& column, double largest) -> std::string {
        const auto doubt = scenario::doubt_of(largest, column);
        return doubt ? std::string(doubt->looks_like) : "";
      },
      py::arg("column"), py::arg("largest"));
  module.def(
      "read_log",
      [](const std::string& file, std::vector<std::string> maps, std::vector<std::string> header,
         std::string period, std::string time_offset, std::string missing) {
        const results::LogChoice choice{std::move(maps), std::move(header), std::move(period),
                                        std::move(time_offset), std::move(missing)};
        results::refuse_auto(choice);
        std::vector<std::string> notes;
        results::Result log = results::read_log(file, choice, notes);
        return std::pair(std::move(log), std::move(notes));
      },
      py::arg("file"), py::arg("maps"), py::arg("header"), py::arg("period"),
      py::arg("time_offset"), py::arg("missing"));
}

// Cases drawn from `--vary KEY=SPEC`.
struct Drawn {
  std::size_t count = 1;
  std::vector<ListedKey> keys;
  std::vector<std::string> units;
  bool draws = false;  // whether any value is random
};

Drawn drawn(const Given& given, const std::vector<std::string>& vary, std::optional<double> samples,
            double seed) {
  const ScenarioFamily& family = shared_family(given);
  Sweep sweep;
  Drawn all;
  for (const std::string& text : vary) {
    sweep.vary.push_back(scenario::split_variation(text));
    all.draws = all.draws || scenario::parse_variation(sweep.vary.back()).random();
  }
  if (vary.empty()) return all;
  sweep.samples = samples;
  sweep.seed = seed;
  const sweep::SweepPlan plan(family, sweep);
  static_cast<void>(plan.check(family, 0, plan.cases(), [](double) { return true; }));
  all.count = plan.cases();
  std::vector<std::vector<double>> numbers(plan.axes().size());
  std::vector<double> row(plan.axes().size());
  for (std::size_t i = 0; i < all.count; ++i) {
    plan.values(i, row.data());
    for (std::size_t k = 0; k < row.size(); ++k) numbers[k].push_back(row[k]);
  }
  for (std::size_t k = 0; k < row.size(); ++k) {
    const sweep::PlanAxis& axis = plan.axes()[k];
    ListedKey key{axis.key};
    if (axis.numeric) {
      key.numbers = std::move(numbers[k]);
    } else {
      for (const double one : numbers[k]) {
        key.texts.push_back(axis.texts[static_cast<std::size_t>(one)]);
      }
    }
    all.keys.push_back(std::move(key));
    all.units.emplace_back(family.unit_of(axis.key, plan.first_settings()));
  }
  return all;
}

// The scenario without slips that are only noted, unless a key or a measure refers to them: they
// change no measure, but take a rig out of the lanes of a sweep.
Given without_notes(const Given& given, const std::vector<std::string>& keys,
                    const std::vector<std::string>& measures) {
  const std::string section = "events.slip";
  const auto slip = shared_family(given).read({}).events.slip;
  const bool is_noted = slip && slip->action == OnEvent::note && !slip->sliding;
  const auto refers = [&](const std::string& key) { return key.starts_with(section); };
  if (!is_noted || std::ranges::any_of(keys, refers)) return given;
  Given without = changed(given, {{section, "null"}});
  const Scenario scenario = shared_family(without).read({});
  for (const std::string& name : measures) {
    const auto measure = scenario::find_measure(name);
    if (!measure || scenario::missing(*measure, scenario)) return given;
  }
  return without;
}

void define_drawn(py::module_& module) {
  py::class_<Drawn>(module, "Drawn")
      .def_readonly("count", &Drawn::count)
      .def_readonly("units", &Drawn::units)
      .def_readonly("draws", &Drawn::draws)
      .def_property_readonly("names",
                             [](const Drawn& all) {
                               std::vector<std::string> names;
                               for (const ListedKey& key : all.keys) names.push_back(key.key);
                               return names;
                             })
      .def("numbers",
           [](const Drawn& all, std::size_t place) {
             return py::array_t<double>(static_cast<py::ssize_t>(all.keys.at(place).numbers.size()),
                                        all.keys.at(place).numbers.data());
           })
      .def("texts", [](const Drawn& all, std::size_t place) { return all.keys.at(place).texts; });
  module.def("without_notes", &without_notes, py::arg("given"), py::arg("keys"),
             py::arg("measures"));
  module.def("drawn", &drawn, py::arg("given"), py::arg("vary"), py::arg("samples"),
             py::arg("seed"));
}

void define_measures(py::module_& module) {
  using scenario::Expectation;
  using Relation = Expectation::Relation;
  py::class_<Expectation>(module, "Expectation")
      .def_readonly("text", &Expectation::text)
      .def_readonly("value", &Expectation::value)
      .def_property_readonly("measure", [](const Expectation& its) { return its.measure.name; })
      .def_property_readonly("unit", [](const Expectation& its) { return its.measure.unit(); })
      .def_property_readonly("upper",
                             [](const Expectation& its) {
                               return its.relation == Relation::below ||
                                      its.relation == Relation::at_most;
                             })
      .def_property_readonly(
          "of_loop",
          [](const Expectation& its) { return its.measure.kind == scenario::Measure::Kind::loop; })
      .def("holds", &Expectation::holds, py::arg("measured"));
  module.def(
      "expectation",
      [](const Given& given, const std::string& option, const std::string& text) {
        return scenario::read_expectation(option, text, shared_family(given).read({}));
      },
      py::arg("given"), py::arg("option"), py::arg("text"));
  module.def(
      "measure_name",
      [](const Given& given, const std::string& option, const std::string& name) {
        const auto its = scenario::measure_named(option, name, shared_family(given).read({}));
        return std::pair(its.name, its.unit());
      },
      py::arg("given"), py::arg("option"), py::arg("name"));
}

}  // namespace

void define_analysis(py::module_& module) {
  define_keys(module);
  define_columns(module);
  define_drawn(module);
  define_measures(module);
  module.def(
      "filled_page",
      [](const std::string& name, const std::string& title, const std::string& json) {
        return replay::filled(replay::read_template(name), title, json);
      },
      py::arg("template"), py::arg("title"), py::arg("json"));
  module.def("short_number", &short_number, py::arg("value"));
  module.def("rounded", &rounded, py::arg("value"), py::arg("digits"));
}

}  // namespace bbsim::python
