// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The compiled part of the Python package bbsim. The documented functions are in its Python part.
#include "module.hpp"

#include <pybind11/complex.h>
#include <pybind11/eigen.h>

#include <algorithm>
#include <complex>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "api/accuracy.hpp"
#include "api/check.hpp"
#include "api/environments.hpp"
#include "api/run.hpp"
#include "api/sweep.hpp"
#include "base/error.hpp"
#include "file/outputs.hpp"
#include "model/control/linearize.hpp"
#include "scenario/family.hpp"
#include "scenario/measures.hpp"

namespace bbsim::python {
namespace {

// Common to the functions below: a callable, a watch, and exceptions raised meanwhile.
class Work {
 public:
  explicit Work(const Given& given) : given_(given) {
    if (!given.callable.is_none()) callable_.emplace(given.callable);
  }

  [[nodiscard]] bool has_callable() const { return callable_.has_value(); }
  [[nodiscard]] Watch& watch() { return watch_; }

  // Call it without the interpreter's lock.
  [[nodiscard]] ScenarioFamily family() {
    ScenarioFamily family = family_of(given_);
    if (callable_) family.give_controller(callable_->factory(watch_));
    return family;
  }
  [[nodiscard]] Scenario scenario() { return family().itself(); }

  template <class Does>
  auto here(const Does& does) {
    return finished([&] { return watch_.here(does); });
  }
  template <class Does>
  auto beside(const Does& does) {
    return finished([&] { return watch_.beside(does); });
  }

 private:
  void throw_if_raised() {
    if (callable_) callable_->throw_if_raised();
    watch_.throw_if_interrupted();
  }

  template <class Does>
  auto finished(const Does& does) {
    try {
      auto made = does();
      throw_if_raised();
      return made;
    } catch (const model::ControllerFault&) {
      throw_if_raised();
      throw;
    }
  }

  const Given& given_;
  Watch watch_;
  std::optional<Callable> callable_;
};

api::RunResult run(const Given& given, const std::optional<Texts>& measures, const Texts& expect,
                   const std::string& output) {
  Work work(given);
  return work.here([&] {
    const ScenarioFamily family = work.family();
    api::RunRequest request;
    request.scenario = family.itself();
    request.inputs = family.inputs();
    const bool feeds_back = request.scenario.controller && commands_of(request.scenario) == nullptr;
    request.measures = measures ? *measures : scenario::default_measures(feeds_back);
    request.expect = expect;
    request.keeps_rows = true;
    if (!output.empty()) {
      file::Outputs outputs;
      api::reads_scenario(outputs, given.text ? "" : given.name, request.scenario);
      outputs.writes(output, "output");
      request.output = output;
    }
    return api::run(request, work.watch());
  });
}

std::string check(const Given& given) {
  Work work(given);
  return work.beside([&] { return to_text(api::check(work.scenario(), work.watch())); });
}

api::Linearized linearize(const Given& given, const std::optional<std::string>& kind,
                          const std::string& at) {
  api::LinearizeRequest request;
  request.kind = api::kind_named(kind.value_or(""));
  request.at = at;
  request.estimates = true;
  Work work(given);
  api::Linearized made = work.beside([&] {
    request.scenario = work.scenario();
    return api::linearize(request, work.watch());
  });
  if (!made.reason.empty()) throw InputError(made.reason);
  return made;
}

// From the only input to the only output, at these frequencies (rad/s).
std::vector<std::complex<double>> response(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                                           const Eigen::MatrixXd& c, const Eigen::MatrixXd& d,
                                           double period, const std::vector<double>& frequencies) {
  const model::FrequencyResponse its(a, b, c, d, period);
  std::vector<std::complex<double>> all;
  for (const double w : frequencies) all.push_back(its.at(w, 0, 0));
  return all;
}

// For each column its name, and its numbers or texts.
py::list sweep(const Given& given, const Pairs& vary, const std::string& combine,
               std::optional<double> samples, std::optional<double> seed, const Texts& measures,
               const Texts& expect, double threads) {
  api::SweepChoice choice{{}, combine, samples, seed, measures};
  for (const auto& [key, spec] : vary) choice.vary.push_back({key, spec});
  Work work(given);
  const api::SweepResult made = work.beside([&] {
    const ScenarioFamily family = work.family();
    api::SweepRequest request{given.name, &family, api::with_choice(family.read_sweep(), choice)};
    // A callable may keep a state, so its cases run one after another.
    request.threads = work.has_callable() ? 1 : threads;
    request.expect = expect;
    return api::sweep(request, work.watch());
  });
  py::list columns;
  for (const file::Column& one : made.table.columns) {
    const auto count = static_cast<py::ssize_t>(one.numbers.size());
    const py::object numbers = py::array_t<double>(count, one.numbers.data());
    columns.append(py::make_tuple(one.name, one.texts.empty() ? numbers : py::cast(one.texts)));
  }
  return columns;
}

// A key of cases: its name, and for each case a number, or a text.
using CaseKey = std::tuple<std::string, Numbers, Texts>;

// Arrays of the columns and measures, and the status of each case, with its reason.
py::tuple simulate(const Given& given, std::size_t count, std::vector<CaseKey> keys,
                   const Texts& columns, const Texts& measures, const std::optional<Numbers>& times,
                   const Numbers& begin, const Numbers& end, const Numbers& start, bool events,
                   double threads) {
  std::vector<sweep::SweepPlan::ListedKey> listed;
  for (auto& [key, numbers, texts] : keys) listed.push_back({key, list_of(numbers), texts});
  sweep::Windows windows{list_of(begin), list_of(end), {}, events};
  for (py::ssize_t i = 0; i < start.size(); i += sweep::start_names.size()) {
    std::copy_n(start.data() + i, sweep::start_names.size(), windows.start.emplace_back().begin());
  }
  std::optional<sweep::CaseTimes> at;
  if (times) {
    const auto each = static_cast<std::size_t>(times->shape(times->ndim() - 1));
    at = {list_of(*times), each, times->ndim() == 2};
  }
  Work work(given);
  // The controller of a callable belongs to this call.
  std::shared_ptr<const ScenarioFamily> family;
  if (!work.has_callable()) family = given.family;
  const py::object owner = py::cast(work.beside([&] {
    if (!family) family = std::make_shared<const ScenarioFamily>(work.family());
    api::CasesRequest request{*family, count, listed, columns, measures, at, windows};
    request.threads = work.has_callable() ? 1 : threads;
    return api::run_cases(request, work.watch());
  }));
  if (!work.has_callable()) given.family = std::move(family);
  const auto& made = owner.cast<const api::CasesResult&>();
  py::list of_columns, of_measures, status, reasons;
  for (const auto& one : made.columns) {
    of_columns.append(py::array_t<double>({made.status.size(), made.times}, one.data(), owner));
  }
  for (const auto& one : made.measures) of_measures.append(view(one, owner));
  for (const auto& one : made.status) {
    status.append(one.word);
    reasons.append(one.reason);
  }
  return py::make_tuple(of_columns, of_measures, status, reasons);
}

// The scenario's title, or its name without one; and what `bbsim accuracy --csv` writes for all
// methods.
std::pair<std::string, std::string> accuracy(const Given& given, const std::string& rtols) {
  const std::vector<double> ladder = api::tolerance_ladder(rtols);
  Work work(given);
  return work.beside([&] {
    const Scenario scenario = work.scenario();
    const std::string title =
        scenario.title.empty() ? std::filesystem::path(given.name).stem().string() : scenario.title;
    return std::pair(title, study::accuracy_csv(api::accuracy(scenario, {}, ladder, work.watch())));
  });
}

void define_run(py::module_& module) {
  using api::RunResult;
  const auto of = [](auto record::RunSummary::*member) {
    return [member](const RunResult& made) { return made.summary.*member; };
  };
  using Summary = record::RunSummary;
  attributes(py::class_<RunResult, std::shared_ptr<RunResult>>(module, "Run"), "columns",
             &RunResult::columns, "units", &RunResult::units, "unmet", &RunResult::unmet,
             "measures", of(&Summary::measures), "warnings", of(&Summary::warnings), "title",
             of(&Summary::title), "status", of(&Summary::status), "reason", of(&Summary::reason))
      .def_property_readonly("summary",
                             [](const RunResult& made) { return record::to_json(made.summary); })
      .def_property_readonly("rows", [](const py::object& self) {
        const auto& made = self.cast<const RunResult&>();
        py::dict rows;
        for (std::size_t i = 0; i < made.columns.size(); ++i) {
          rows[py::str(made.columns[i])] = view(made.rows.columns[i].numbers, self);
        }
        return rows;
      });
  module.def("run", &run);
}

void define_linearize(py::module_& module) {
  using api::Linearized;
  using model::LinearSystem;
  const auto signals = [](std::vector<model::LinearSignal> LinearSystem::*member) {
    return [member](const LinearSystem& its) {
      Pairs names;
      for (const auto& signal : its.*member) names.emplace_back(signal.name, signal.unit);
      return names;
    };
  };
  attributes(py::class_<LinearSystem>(module, "LinearSystem"), "A", &LinearSystem::a, "B",
             &LinearSystem::b, "C", &LinearSystem::c, "D", &LinearSystem::d, "dt",
             &LinearSystem::period, "states", signals(&LinearSystem::states), "inputs",
             signals(&LinearSystem::inputs), "outputs", signals(&LinearSystem::outputs));
  attributes(
      py::class_<Linearized>(module, "Linearized"), "kind", &Linearized::kind, "at",
      &Linearized::at, "note", &Linearized::note, "system",
      [](const Linearized& made) { return made.linearization.system; }, "frequencies",
      [](const Linearized& made) { return model::open_loop_frequencies(made.linearization); },
      "json", [](const Linearized& made) { return api::file_text(made, ".json"); }, "report",
      [](const Linearized& made) { return to_text(api::report_of(made)); }, "open_loops",
      [](const Linearized& made) { return made.linearization.margins; });
  attributes(py::class_<model::LoopMargins>(module, "LoopMargins"), "command",
             &model::LoopMargins::command, "open", &model::LoopMargins::open);
  module.def("response", &response);
  module.def("linearize", &linearize);
}

using api::Environments;
using Indices = std::vector<std::size_t>;
using Drawn = std::vector<std::pair<Texts, std::size_t>>;  // values as texts, and a seed

// Begins some runs; with commands, two for each run, steps the others.
void advance(Environments& its, const std::optional<Numbers>& commands, const Indices& which,
             const Drawn& drawn) {
  std::vector<Environments::Beginning> how;
  for (const auto& [values, seed] : drawn) how.push_back({values, seed});
  const double* const of = commands ? commands->data() : nullptr;
  const WithoutLock unlocked;
  if (of == nullptr) return its.begin(which, how);
  its.step(std::span(of, 2 * its.count()), which, how);
}

void define_environments(py::module_& module) {
  const auto of_each = []<class T>(T (Environments::*of)(std::size_t) const) {
    return [of](const Environments& its) {
      py::array_t<T> all(static_cast<py::ssize_t>(its.count()));
      for (std::size_t i = 0; i < its.count(); ++i) all.mutable_data()[i] = (its.*of)(i);
      return all;
    };
  };
  attributes(
      py::class_<Environments>(module, "Environments"), "command_unit",
      [](const Environments& its) { return command_unit(its.scenario().controller->drives); },
      "limits",
      [](const Environments& its) {
        const Controller& controller = *its.scenario().controller;
        return std::pair(controller.limit_of(0), controller.limit_of(1));
      },
      "terminated", of_each(&Environments::terminated), "truncated",
      of_each(&Environments::truncated), "costs_of_ending", of_each(&Environments::cost_of_ending),
      "in_lanes", &Environments::in_lanes, "observations",
      [](const py::object& self) {
        const auto& its = self.cast<const Environments&>();
        return py::array_t<double>({its.count(), Environments::columns().size()},
                                   its.observations().data(), self);
      })
      .def(py::init([](const Given& given, std::size_t count, Texts keys, bool keeps_rows) {
        return std::make_unique<Environments>(family_of(given), count, std::move(keys), keeps_rows);
      }))
      .def("advance", &advance)
      .def("result", &Environments::result, py::return_value_policy::copy);
  py::list columns;
  for (const auto& one : Environments::columns()) {
    columns.append(py::make_tuple(one.name, one.unit, one.meaning));
  }
  module.attr("OBSERVATIONS") = columns;
}

void raise(const char* type, const py::object& argument) {
  const py::object its = py::module_::import("bbsim._scenario").attr(type);
  PyErr_SetObject(its.ptr(), its(argument).ptr());
}

void translate(std::exception_ptr pointer) {
  try {
    if (pointer) std::rethrow_exception(pointer);
  } catch (const InputError& error) {
    py::list problems;
    for (const Problem& problem : error.problems()) {
      problems.append(py::make_tuple(problem.where, problem.message));
    }
    raise("InputError", problems);
  } catch (const ReaderGone& error) {
    PyErr_SetString(PyExc_BrokenPipeError, error.what());
  } catch (const OutputError& error) {
    raise("OutputError", py::str(error.what()));
  } catch (const model::ControllerFault& fault) {
    raise("ControllerError", py::str(fault.what()));
  }
}

}  // namespace
}  // namespace bbsim::python

PYBIND11_MODULE(_bbsim, module) {
  using namespace bbsim::python;
  module.doc() = "The compiled part of bbsim.";
  module.attr("__version__") = BBSIM_VERSION;
  module.attr("START") = bbsim::sweep::start_names;
  py::register_exception_translator(translate);
  end_work_with_the_interpreter();
  py::class_<Given> given(module, "Given");
  given.def(py::init<std::string, std::optional<std::string>, Texts, py::object>())
      .def_property_readonly("name",
                             [](const Given& given) { return shared_family(given).source().file; })
      .def("changed", &changed);
  define_sample(module);
  define_run(module);
  define_linearize(module);
  define_environments(module);
  define_results(module);
  define_analysis(module, given);
  py::class_<bbsim::api::CasesResult>(module, "CasesResult");
  module.def("sweep", &sweep);
  module.def("simulate", &simulate);
  module.def("check", &check);
  module.def("accuracy", &accuracy);
  module.def("key_and_hint", [](const std::string& message) {
    const bbsim::KeyAndHint found = bbsim::key_and_hint(message);
    return std::pair(found.key, found.hint);
  });
}
