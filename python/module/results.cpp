// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "results.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "api/inputs.hpp"
#include "base/error.hpp"
#include "base/printable.hpp"
#include "file/atomic_file.hpp"
#include "file/default_name.hpp"
#include "file/outputs.hpp"
#include "file/temporaries.hpp"
#include "results/log.hpp"
#include "results/read_result.hpp"
#include "results/sweep_table.hpp"
#include "scenario/columns.hpp"
#include "scenario/measures.hpp"
#include "yaml/nearest.hpp"

namespace bbsim::python {
namespace {

namespace py = pybind11;
using results::Column;
using results::Result;

py::array_t<double> view(const std::vector<double>& values, const py::object& owner) {
  return {{static_cast<py::ssize_t>(values.size())}, {sizeof(double)}, values.data(), owner};
}

const Column& column_of(const Result& result, const std::string& name) {
  const Column* const found = result.find(name);
  if (found == nullptr) throw py::key_error(name);
  return *found;
}

// The result, with the instant at which an event ended it as its last row; and notes on what a log
// was changed to.
std::pair<Result, std::vector<std::string>> read(const std::string& file,
                                                 const results::Beside& beside,
                                                 const results::LogChoice& log) {
  std::pair<Result, std::vector<std::string>> made;
  made.first = results::read_result(file, beside, log, &made.second);
  if (!made.first.left_out.empty()) made.second.push_back(made.first.left_out);
  results::add_end_row(made.first);
  return made;
}

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

// `columns`: for each, its name, its unit, its numbers, and its texts if it is one of texts.
Result in_memory(
    const std::vector<std::tuple<std::string, std::string, Numbers, std::vector<std::string>>>&
        columns,
    const std::string& summary) {
  std::vector<Column> all;
  for (const auto& [name, unit, numbers, texts] : columns) {
    all.push_back({name, {numbers.data(), numbers.data() + numbers.size()}, texts, unit});
  }
  Result made = results::result_of(std::move(all), summary);
  results::add_end_row(made);
  return made;
}

// What bbsim knows of a column, where commands have this unit: name, symbol, unit, the number of
// its panel, the panel's heading, role, symbol below that heading, axis.
using Known =
    std::tuple<std::string, std::string, std::string, int, std::string, int, std::string, int>;
std::vector<Known> known_columns(const std::string& command_unit) {
  std::vector<Known> all;
  const auto add = [&](const scenario::Column& column) {
    const std::string_view unit = scenario::is_command(column.name) ? command_unit : column.unit;
    const scenario::Panel panel = scenario::panel_of(column, unit);
    all.emplace_back(column.name, column.symbol, unit, static_cast<int>(panel),
                     scenario::text_of(panel).heading, static_cast<int>(column.role), column.beside,
                     scenario::axis_of(column.name));
  };
  std::ranges::for_each(scenario::catalogue, add);
  add(scenario::position_error);
  return all;
}

// The unit of a measure, and the column whose values it has; empty if they are not a column's.
std::pair<std::string, std::string> measure_unit(const std::string& name) {
  const std::optional<scenario::Measure> measure = scenario::find_measure(name);
  if (!measure) return {name == "end_time" ? "s" : "", ""};
  const bool of_column = measure->column != nullptr && measure->unit() == measure->column->unit;
  return {measure->unit(), of_column ? std::string(measure->column->name) : ""};
}

std::string nearest(const std::string& word, const std::vector<std::string>& names) {
  const std::vector<std::string_view> views(names.begin(), names.end());
  return std::string(yaml::nearest_name(word, views));
}

void define_stored(py::module_& module) {
  py::class_<results::Event>(module, "StoredEvent")
      .def_readonly("name", &results::Event::name)
      .def_readonly("stopped", &results::Event::stopped)
      .def_readonly("t", &results::Event::t)
      .def_readonly("x", &results::Event::x)
      .def_readonly("y", &results::Event::y);
  py::class_<Result>(module, "Stored")
      .def(py::init(&in_memory), py::arg("columns"), py::arg("summary"))
      .def_readonly("file", &Result::file)
      .def_readonly("rows", &Result::rows)
      .def_readonly("title", &Result::title)
      .def_readonly("status", &Result::status)
      .def_readonly("end_time", &Result::end_time)
      .def_readonly("events", &Result::events)
      .def_readonly("units_known", &Result::units_known)
      .def_readonly("has_end_row", &Result::has_end_row)
      .def_property_readonly("shown_file", &Result::shown_file)
      .def_property_readonly("is_sweep", &Result::is_sweep)
      .def_property_readonly("names", &Result::names)
      .def("unit",
           [](const Result& one, const std::string& name) { return column_of(one, name).unit; })
      .def("is_text", [](const Result& one,
                         const std::string& name) { return column_of(one, name).is_text(); })
      .def("numbers",
           [](const py::object& self, const std::string& name) {
             return view(column_of(self.cast<const Result&>(), name).numbers, self);
           })
      .def_property_readonly(
          "scenario_text",
          [](const Result& one) { return one.scenario ? one.scenario->source.text : ""; })
      // Diameter of a round plate, or the sides of a rectangular one, m.
      .def_property_readonly(
          "plate",
          [](const Result& one) -> std::vector<double> {
            if (!one.scenario) return {};
            if (one.scenario->plate.diameter) return {*one.scenario->plate.diameter};
            const auto& size = one.scenario->plate.size;
            return size ? std::vector<double>{(*size)[0], (*size)[1]} : std::vector<double>();
          })
      .def_property_readonly("friction",
                             [](const Result& one) -> std::optional<double> {
                               if (!one.scenario || !one.scenario->events.slip) return {};
                               return one.scenario->events.slip->friction;
                             })
      // The unit of commands; None without a controller.
      .def_property_readonly("command_unit",
                             [](const Result& one) -> std::optional<std::string> {
                               if (!one.scenario || !one.scenario->controller) return {};
                               return std::string(command_unit(one.scenario->controller->drives));
                             })
      .def_property_readonly("sampled", [](const Result& one) -> std::optional<bool> {
        if (!one.scenario || !one.scenario->controller) return {};
        return one.scenario->controller->sampling.has_value();
      });
  module.def(
      "read_result",
      [](const std::string& file, std::string summary, std::string scenario,
         std::vector<std::string> overrides, std::vector<std::string> maps,
         std::vector<std::string> header, std::string period, std::string time_offset,
         std::string missing) {
        const results::LogChoice log{std::move(maps), std::move(header), std::move(period),
                                     std::move(time_offset), std::move(missing)};
        results::refuse_auto(log);
        return read(file, {std::move(summary), std::move(scenario), std::move(overrides)}, log);
      },
      py::arg("file"), py::arg("summary"), py::arg("scenario"), py::arg("overrides"),
      py::arg("maps"), py::arg("header"), py::arg("period"), py::arg("time_offset"),
      py::arg("missing"));
}

void define_sweeps(py::module_& module) {
  using results::Key;
  using results::SweepTable;
  py::class_<Key>(module, "SweepKey")
      .def_readonly("name", &Key::name)
      .def_readonly("labels", &Key::labels)
      .def_readonly("unit", &Key::unit)
      .def_readonly("drawn", &Key::drawn)
      .def_readonly("leader", &Key::leader)
      .def_property_readonly(
          "values",
          [](const py::object& self) { return view(self.cast<const Key&>().values, self); })
      .def_property_readonly("distinct", [](const py::object& self) {
        return view(self.cast<const Key&>().distinct, self);
      });
  py::class_<SweepTable>(module, "SweepTable")
      .def_readonly("keys", &SweepTable::keys)
      .def_readonly("status", &SweepTable::status)
      .def_readonly("others", &SweepTable::others)
      .def("followers", &SweepTable::followers)
      .def_property_readonly("measures", [](const SweepTable& table) {
        std::vector<std::string> names;
        for (const Column* column : table.measures) names.push_back(column->name);
        return names;
      });
  module.def("sweep_table", &results::sweep_table, py::arg("stored"), py::keep_alive<0, 1>());
}

// From now on a signal ends the process at once, even while it waits for input; no part of a file
// stays.
void end_at_signals() {
  struct sigaction action {};
  action.sa_handler = [](int) {
    file::remove_temporaries();
    _exit(static_cast<int>(ExitCode::interrupted));
  };
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before {};
    sigaction(signal, &action, &before);
    if (before.sa_handler == SIG_IGN) sigaction(signal, &before, nullptr);
  }
}

void define_files(py::module_& module) {
  using file::Outputs;
  py::class_<Outputs>(module, "Outputs")
      .def(py::init())
      .def("reads", &Outputs::reads, py::arg("file"), py::arg("what"))
      .def("writes", &Outputs::writes, py::arg("file"), py::arg("what"))
      .def("reads_with",
           [](Outputs& outputs, const Result& result) { api::reads_with_result(outputs, result); });
  module.def("summary_beside", &results::summary_beside, py::arg("file"));
  module.def(
      "require_mark",
      [](const std::string& target, const std::string& what, const std::string& mark) {
        file::require_like(target, {.what = what, .mark = mark});
      },
      py::arg("target"), py::arg("what"), py::arg("mark"));
  module.def(
      "write_file",
      [](const std::string& target, const py::bytes& content) {
        file::write_file(target, static_cast<std::string_view>(content));
      },
      py::arg("target"), py::arg("content"));
  module.def("end_at_signals", &end_at_signals);
  module.def(
      "printable", [](const std::string& text) { return printable(text); }, py::arg("text"));
}

}  // namespace

void define_results(py::module_& module) {
  define_stored(module);
  define_sweeps(module);
  define_files(module);
  module.def("known_columns", &known_columns, py::arg("command_unit"));
  module.def("measure_unit", &measure_unit, py::arg("name"));
  module.def("nearest", &nearest, py::arg("word"), py::arg("names"));
}

}  // namespace bbsim::python
