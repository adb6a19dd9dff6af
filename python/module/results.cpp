// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Stored results, what bbsim knows of their columns, pages and comparisons of them, and files
// written whole.
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "api/measure.hpp"
#include "api/replay.hpp"
#include "api/run.hpp"
#include "base/error.hpp"
#include "base/progress_line.hpp"
#include "base/text.hpp"
#include "file/atomic_file.hpp"
#include "file/default_name.hpp"
#include "file/leftovers.hpp"
#include "file/outputs.hpp"
#include "module.hpp"
#include "replay/page.hpp"
#include "replay/template.hpp"
#include "results/result.hpp"
#include "scenario/columns.hpp"
#include "scenario/measures.hpp"
#include "scenario/reader.hpp"
#include "yaml/spelling.hpp"

namespace bbsim::python {
namespace {

using results::Column;
using results::Result;

const Column& column_of(const Result& result, const std::string& name) {
  const Column* const found = result.find(name);
  if (found == nullptr) throw py::key_error(name);
  return *found;
}

// The result, with the instant at which an event ended it as its last row. Its notes say what a log
// was changed to.
Result read_result(const std::string& file, const results::Beside& beside,
                   const results::LogChoice& log) {
  results::refuse_auto(log);
  Result made = results::read_result(file, beside, log);
  if (!made.left_out.empty()) made.notes.push_back(made.left_out);
  results::add_end_row(made);
  return made;
}

Result read_log(const std::string& file, const results::LogChoice& choice) {
  results::refuse_auto(choice);
  return results::read_log(file, choice);
}

// `columns`: for each, its name, its unit, its numbers, and its texts if it is one of texts.
Result in_memory(const std::vector<std::tuple<std::string, std::string, Numbers, Texts>>& columns,
                 const std::string& summary) {
  std::vector<Column> all;
  for (const auto& [name, unit, numbers, texts] : columns) {
    all.push_back({name, list_of(numbers), texts, unit});
  }
  Result made = results::result_of(std::move(all), summary);
  results::add_end_row(made);
  return made;
}

// What bbsim knows of a column, where commands have this unit: name, symbol, unit, the number of
// its panel, the panel's heading, role, symbol below that heading, axis.
py::list known_columns(const std::string& command_unit) {
  py::list all;
  const auto add = [&](const scenario::Column& column) {
    const std::string_view unit = scenario::is_command(column.name) ? command_unit : column.unit;
    const scenario::Panel& panel = scenario::panel_of(column, unit);
    all.append(py::make_tuple(column.name, column.symbol, unit, &panel - scenario::panels.data(),
                              panel.heading, static_cast<int>(column.role), column.beside,
                              scenario::axis_of(column.name)));
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

// The diameter, or the sides, m. This and the following: empty without a scenario, or if it has
// none.
std::vector<double> plate_of(const Result& one) {
  if (!one.scenario) return {};
  if (one.scenario->plate.diameter) return {*one.scenario->plate.diameter};
  const auto& size = one.scenario->plate.size;
  return size ? std::vector<double>{(*size)[0], (*size)[1]} : std::vector<double>();
}

std::optional<double> friction_of(const Result& one) {
  if (!one.scenario || !one.scenario->events.slip) return {};
  return one.scenario->events.slip->friction;
}

// Of the commands: their unit, and whether a sampled controller gives them.
std::optional<std::pair<std::string, bool>> controller_of(const Result& one) {
  if (!one.scenario || !one.scenario->controller) return {};
  const Controller& its = *one.scenario->controller;
  return std::pair(std::string(command_unit(its.drives)), its.sampling.has_value());
}

// A page, why a scenario's run ended early, and notes.
using Page = std::tuple<std::string, std::string, Texts>;
using Shown = std::variant<std::string, Result>;

// `output` is the file that the caller will write, or empty.
Page replay(const std::vector<Shown>& shown, const Texts& logs, const results::LogChoice& log,
            const results::Beside& beside, const std::string& title, const std::string& output) {
  api::ReplayRequest request;
  for (const Shown& one : shown) {
    if (const auto* const file = std::get_if<std::string>(&one)) {
      request.shown.push_back({*file});
    } else {
      const auto& result = std::get<Result>(one);
      request.shown.push_back({result.file.empty() ? "run" : result.file, result});
    }
  }
  request.logs = logs;
  request.log = log;
  request.beside = beside;
  request.title = title;
  Watch watch;
  Page page = watch.beside([&] {
    const std::string page_template = replay::read_template(replay::replay_name);
    file::Outputs outputs;
    request.before_running = [&] {
      if (!output.empty()) outputs.writes(output, "output");
    };
    const api::ReplayResult made = api::replay(request, outputs, watch);
    Page all(replay::page(made.scene, page_template), "", {});
    auto& [text, reason, notes] = all;
    for (const api::RunResult& run : made.runs) {
      if (reason.empty()) reason = run.summary.reason;
      notes.insert(notes.end(), run.summary.warnings.begin(), run.summary.warnings.end());
    }
    notes.insert(notes.end(), watch.notes().begin(), watch.notes().end());
    return all;
  });
  watch.throw_if_interrupted();
  return page;
}

// Whether they are alike, the table, why a scenario's run ended early, and warnings.
std::tuple<bool, std::string, std::string, Texts> compare(
    const std::string& a, const std::string& b, const Texts& overrides, std::optional<double> rtol,
    std::optional<double> atol, const Texts& columns, const results::LogChoice& log) {
  Watch watch;
  api::Compared made = watch.beside([&] {
    api::CompareRequest request{a, b, rtol, atol, columns, log, {}};
    if (api::is_scenario(b)) {
      request.run = read_scenario(b, overrides);
    } else if (!overrides.empty()) {
      throw InputError("set: allowed with a scenario as b, in which it sets a key");
    }
    return api::compare(request, watch);
  });
  watch.throw_if_interrupted();
  return {made.alike, made.text, made.reason, made.warnings};
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

}  // namespace

void define_results(py::module_& module) {
  using file::Outputs;
  using results::Event;
  using results::Key;
  using results::LogChoice;
  using results::SweepTable;
  py::class_<results::Beside>(module, "Beside").def(py::init<std::string, std::string, Texts>());
  py::class_<LogChoice>(module, "LogChoice")
      .def(py::init<Texts, Texts, std::string, std::string, std::string>());
  attributes(py::class_<Event>(module, "StoredEvent"), "name", &Event::name, "stopped",
             &Event::stopped, "t", &Event::t, "x", &Event::x, "y", &Event::y);
  attributes(
      py::class_<Result>(module, "Stored"), "file", &Result::file, "rows", &Result::rows, "title",
      &Result::title, "status", &Result::status, "end_time", &Result::end_time, "events",
      &Result::events, "units_known", &Result::units_known, "has_end_row", &Result::has_end_row,
      "shown_file", &Result::shown_file, "notes", &Result::notes, "is_sweep", &Result::is_sweep,
      "names", &Result::names, "raw", &Result::raw, "scenario_text",
      [](const Result& one) { return one.scenario ? one.scenario->source.text : ""; }, "plate",
      &plate_of, "friction", &friction_of, "controller", &controller_of)
      .def(py::init(&in_memory))
      .def("unit",
           [](const Result& one, const std::string& name) { return column_of(one, name).unit; })
      .def("is_text", [](const Result& one,
                         const std::string& name) { return column_of(one, name).is_text(); })
      .def("numbers", [](const py::object& self, const std::string& name) {
        return view(column_of(self.cast<const Result&>(), name).numbers, self);
      });
  attributes(py::class_<Key>(module, "SweepKey"), "name", &Key::name, "labels", &Key::labels,
             "unit", &Key::unit, "drawn", &Key::drawn, "leader", &Key::leader, "values",
             &Key::values, "distinct", &Key::distinct);
  attributes(py::class_<SweepTable>(module, "SweepTable"), "keys", &SweepTable::keys, "status",
             &SweepTable::status, "others", &SweepTable::others, "measures",
             [](const SweepTable& table) {
               Texts names;
               for (const Column* column : table.measures) names.push_back(column->name);
               return names;
             })
      .def("followers", &SweepTable::followers);
  module.def("read_result", &read_result);
  module.def("read_log", &read_log);
  module.def("sweep_table", &results::sweep_table, py::keep_alive<0, 1>());
  module.def("summary_beside", &results::summary_beside);
  module.def("known_columns", &known_columns);
  module.def("measure_unit", &measure_unit);
  module.def("nearest", [](const std::string& word, const Texts& names) {
    const std::vector<std::string_view> views(names.begin(), names.end());
    return std::string(yaml::nearest_name(word, views));
  });
  module.def("replay", &replay);
  module.def("compare", &compare);
  py::class_<Outputs>(module, "Outputs")
      .def(py::init())
      .def("reads", &Outputs::reads)
      .def("writes", &Outputs::writes)
      .def("reads_scenario",
           [](Outputs& outputs, const Given& given) {
             // A fit may give a value that the text lacks.
             const Source& source = shared_family(given).source();
             api::reads_scenario(outputs, given.name,
                                 parse_sound_parts(source.text, source.file, source.overrides));
           })
      .def("reads_with", &api::reads_with_result);
  module.def("require_mark",
             [](const std::string& target, const std::string& what, const std::string& mark) {
               file::require_like(target, {.what = what, .mark = mark});
             });
  module.def("write_file", &file::write_file);
  module.def("end_at_signals", &end_at_signals);
  module.def("printable", &printable);
  module.def("progress_line", [](const std::string& label, const std::string& detail, double done,
                                 std::optional<double> seconds_left, std::size_t columns) {
    return progress_line({printable(label), printable(detail), done, seconds_left}, columns);
  });
}

}  // namespace bbsim::python
