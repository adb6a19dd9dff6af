// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The compiled part of the Python package bbsim. The documented functions are in its Python part.
#include <pybind11/complex.h>
#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "analysis.hpp"
#include "api/accuracy.hpp"
#include "api/cases.hpp"
#include "api/check.hpp"
#include "api/environments.hpp"
#include "api/fault.hpp"
#include "api/inputs.hpp"
#include "api/linearize.hpp"
#include "api/run.hpp"
#include "api/sweep.hpp"
#include "base/error.hpp"
#include "callable.hpp"
#include "file/outputs.hpp"
#include "pages.hpp"
#include "results.hpp"
#include "scenario/family.hpp"
#include "scenario/measures.hpp"
#include "watch.hpp"

namespace bbsim::python {
namespace {

Scenario first_of(const ScenarioFamily& family) {
  Scenario scenario = family.read({});
  scenario.source = family.source();
  return scenario;
}

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

using Column = py::array_t<double>;

// An array on memory of `owner`, which the array keeps alive.
Column view(const std::vector<double>& values, const py::object& owner) {
  return {{static_cast<py::ssize_t>(values.size())}, {sizeof(double)}, values.data(), owner};
}

std::size_t place_of_column(const api::RunResult& made, const std::string& name) {
  const auto found = std::ranges::find(made.columns, name);
  if (found == made.columns.end()) throw py::key_error(name);
  return static_cast<std::size_t>(found - made.columns.begin());
}

std::vector<std::string> measures_of(const std::optional<std::vector<std::string>>& asked,
                                     const Scenario& scenario) {
  if (asked) return *asked;
  return scenario::default_measures(scenario.controller && commands_of(scenario) == nullptr);
}

api::RunResult run(const Given& given, const std::optional<std::vector<std::string>>& measures,
                   const std::vector<std::string>& expect, const std::string& output) {
  Work work(given);
  return work.here([&] {
    const ScenarioFamily family = work.family();
    api::RunRequest request;
    request.scenario = first_of(family);
    request.inputs = family.inputs();
    request.measures = measures_of(measures, request.scenario);
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

// The number (SI) that a text such as "2 cm" gives the key; empty if the key has no single number.
std::optional<double> number_at(const Given& given, const std::string& key,
                                const std::string& value) {
  return shared_family(given).number_at(key, {{key, value}});
}

std::string check(const Given& given) {
  Work work(given);
  return work.beside([&] {
    const ScenarioFamily family = work.family();
    return to_text(api::check(first_of(family), work.watch()));
  });
}

api::Linearized linearize(const Given& given, const std::optional<std::string>& kind,
                          const std::string& at) {
  api::LinearizeRequest request;
  request.kind = api::kind_named(kind.value_or(""));
  request.at = at;
  request.estimates = true;
  Work work(given);
  api::Linearized made = work.beside([&] {
    const ScenarioFamily family = work.family();
    request.scenario = first_of(family);
    return api::linearize(request, work.watch());
  });
  if (!made.reason.empty()) throw InputError(made.reason);
  return made;
}

api::SweepResult sweep(const Given& given, const api::SweepChoice& choice,
                       const std::vector<std::string>& expect, double threads) {
  Work work(given);
  return work.beside([&] {
    const ScenarioFamily family = work.family();
    api::SweepRequest request{
        given.name, family, api::with_choice(family.read_sweep(), choice), {}, {}};
    // A callable may keep a state, so its cases run one after another.
    request.threads = work.has_callable() ? 1 : threads;
    request.expect = expect;
    return api::sweep(request, work.watch());
  });
}

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

std::vector<double> list_of(const Numbers& numbers) {
  return {numbers.data(), numbers.data() + numbers.size()};
}

struct CasesAsked {
  std::size_t count;
  std::vector<sweep::SweepPlan::ListedKey> keys;
  std::vector<std::string> columns, measures;
  std::optional<sweep::CaseTimes> times;
  sweep::Windows windows;
};

api::CasesResult simulate(const Given& given, const CasesAsked& asked, double threads) {
  Work work(given);
  // The controller of a callable belongs to this call.
  std::shared_ptr<const ScenarioFamily> family;
  if (!work.has_callable()) family = given.family;
  api::CasesResult made = work.beside([&] {
    if (!family) family = std::make_shared<const ScenarioFamily>(work.family());
    api::CasesRequest request{*family,        asked.count, asked.keys,   asked.columns,
                              asked.measures, asked.times, asked.windows};
    request.threads = work.has_callable() ? 1 : threads;
    return api::run_cases(request, work.watch());
  });
  if (!work.has_callable()) given.family = std::move(family);
  return made;
}

void define_simulate(py::module_& module) {
  using api::CasesResult;
  using Key = sweep::SweepPlan::ListedKey;
  py::class_<Key>(module, "CaseKey")
      .def(py::init([](std::string key, const Numbers& numbers, std::vector<std::string> texts) {
             return Key{std::move(key), list_of(numbers), std::move(texts)};
           }),
           py::arg("key"), py::arg("numbers"), py::arg("texts"));
  py::class_<CasesAsked>(module, "CasesAsked")
      .def(
          py::init([](std::size_t count, std::vector<Key> keys, std::vector<std::string> columns,
                      std::vector<std::string> measures, const std::optional<Numbers>& times,
                      const Numbers& begin, const Numbers& end, const Numbers& start, bool events) {
            CasesAsked asked{count,
                             std::move(keys),
                             std::move(columns),
                             std::move(measures),
                             {},
                             {list_of(begin), list_of(end), {}, events}};
            for (py::ssize_t i = 0; i < start.size(); i += sweep::start_names.size()) {
              std::copy_n(start.data() + i, sweep::start_names.size(),
                          asked.windows.start.emplace_back().begin());
            }
            if (times) {
              asked.times = {list_of(*times),
                             static_cast<std::size_t>(times->shape(times->ndim() - 1)),
                             times->ndim() == 2};
            }
            return asked;
          }),
          py::arg("count"), py::arg("keys"), py::arg("columns"), py::arg("measures"),
          py::arg("times"), py::arg("begin"), py::arg("end"), py::arg("start"), py::arg("events"));
  py::class_<CasesResult>(module, "CasesResult")
      .def("column",
           [](const py::object& self, std::size_t place) {
             const auto& made = self.cast<const CasesResult&>();
             return Column({made.status.size(), made.times}, made.columns.at(place).data(), self);
           })
      .def("measure",
           [](const py::object& self, std::size_t place) {
             return view(self.cast<const CasesResult&>().measures.at(place), self);
           })
      .def_property_readonly("times", [](const CasesResult& made) { return made.times; })
      .def_property_readonly("status",
                             [](const CasesResult& made) {
                               std::vector<std::string> words;
                               for (const auto& one : made.status) words.push_back(one.word);
                               return words;
                             })
      .def_property_readonly("reason", [](const CasesResult& made) {
        std::vector<std::string> texts;
        for (const auto& one : made.status) texts.push_back(one.reason);
        return texts;
      });
  module.attr("START") = py::cast(sweep::start_names);
  module.def("simulate", &simulate, py::arg("given"), py::arg("asked"), py::arg("threads"));
}

// The scenario's title, or its name without one; and what `bbsim accuracy --csv` writes for all
// methods.
std::pair<std::string, std::string> accuracy(const Given& given, const std::string& rtols) {
  std::vector<Method> methods;
  for (const NamedMethod& known : named_methods) {
    if (known.method != Method::automatic) methods.push_back(known.method);
  }
  const std::vector<double> ladder = api::tolerance_ladder(rtols);
  Work work(given);
  return work.beside([&] {
    const Scenario scenario = first_of(work.family());
    const std::string title =
        scenario.title.empty() ? std::filesystem::path(given.name).stem().string() : scenario.title;
    return std::pair(title,
                     api::accuracy_csv(api::accuracy(scenario, methods, ladder, work.watch())));
  });
}

void define_run(py::module_& module) {
  using api::RunResult;
  const auto text = [](std::string record::RunSummary::*member) {
    return [member](const RunResult& made) { return made.summary.*member; };
  };
  py::class_<RunResult, std::shared_ptr<RunResult>>(module, "Run")
      .def_readonly("columns", &RunResult::columns)
      .def_readonly("units", &RunResult::units)
      .def_readonly("unmet", &RunResult::unmet)
      .def("column",
           [](const py::object& self, const std::string& name) {
             const auto& made = self.cast<const RunResult&>();
             return view(made.rows.columns[place_of_column(made, name)], self);
           })
      .def_property_readonly("measures",
                             [](const RunResult& made) { return made.summary.measures; })
      .def_property_readonly("warnings",
                             [](const RunResult& made) { return made.summary.warnings; })
      .def_property_readonly("title", text(&record::RunSummary::title))
      .def_property_readonly("status", text(&record::RunSummary::status))
      .def_property_readonly("reason", text(&record::RunSummary::reason))
      .def("summary", [](const RunResult& made) { return record::to_json(made.summary); });
  module.def("run", &run, py::arg("given"), py::arg("measures"), py::arg("expect"),
             py::arg("output"));
}

void define_sweep(py::module_& module) {
  py::class_<api::SweepChoice>(module, "SweepChoice")
      .def(py::init([](const std::vector<std::pair<std::string, std::string>>& vary,
                       std::string combine, std::optional<double> samples,
                       std::optional<double> seed, std::vector<std::string> measures) {
             api::SweepChoice choice{{}, std::move(combine), samples, seed, std::move(measures)};
             for (const auto& [key, spec] : vary) choice.vary.push_back({key, spec});
             return choice;
           }),
           py::arg("vary"), py::arg("combine"), py::arg("samples"), py::arg("seed"),
           py::arg("measures"));
  using Its = api::SweepTable::Column;
  py::class_<Its>(module, "SweepColumn")
      .def_readonly("name", &Its::name)
      .def_readonly("unit", &Its::unit)
      .def_readonly("is_text", &Its::is_text)
      .def_readonly("texts", &Its::texts)
      .def_property_readonly("numbers", [](const py::object& self) {
        return view(self.cast<const Its&>().numbers, self);
      });
  py::class_<api::SweepResult>(module, "Sweep")
      .def_readonly("engine", &api::SweepResult::engine)
      .def_property_readonly(
          "columns",
          [](const api::SweepResult& made) -> const std::vector<Its>& {
            return made.table.columns;
          },
          py::return_value_policy::reference_internal);
  module.def("sweep", &sweep, py::arg("given"), py::arg("choice"), py::arg("expect"),
             py::arg("threads"));
}

std::vector<std::pair<std::string, std::string>> names_of(
    const std::vector<model::LinearSignal>& signals) {
  std::vector<std::pair<std::string, std::string>> names;
  for (const model::LinearSignal& signal : signals) names.emplace_back(signal.name, signal.unit);
  return names;
}

void define_linearize(py::module_& module) {
  using api::Linearized;
  const auto matrix = [](Eigen::MatrixXd model::LinearSystem::*member) {
    return [member](const Linearized& made) { return made.linearisation.system.*member; };
  };
  const auto signals = [](std::vector<model::LinearSignal> model::LinearSystem::*member) {
    return [member](const Linearized& made) { return names_of(made.linearisation.system.*member); };
  };
  using model::LinearSystem;
  py::class_<LinearSystem>(module, "LinearSystem")
      .def_readonly("A", &LinearSystem::a)
      .def_readonly("B", &LinearSystem::b)
      .def_readonly("C", &LinearSystem::c)
      .def_readonly("D", &LinearSystem::d)
      .def_readonly("dt", &LinearSystem::period)
      .def_property_readonly("states", [](const LinearSystem& its) { return names_of(its.states); })
      .def_property_readonly("inputs",
                             [](const LinearSystem& its) { return names_of(its.inputs); });
  py::class_<Linearized>(module, "Linearized")
      .def_property_readonly("A", matrix(&LinearSystem::a))
      .def_property_readonly("B", matrix(&LinearSystem::b))
      .def_property_readonly("C", matrix(&LinearSystem::c))
      .def_property_readonly("D", matrix(&LinearSystem::d))
      .def_property_readonly(
          "dt", [](const Linearized& made) { return made.linearisation.system.period; })
      .def_property_readonly("states", signals(&LinearSystem::states))
      .def_property_readonly("inputs", signals(&LinearSystem::inputs))
      .def_property_readonly("outputs", signals(&LinearSystem::outputs))
      .def_readonly("kind", &Linearized::kind)
      .def_readonly("at", &Linearized::at)
      .def_readonly("note", &Linearized::note)
      .def("open_loop",
           [](const Linearized& made, const std::string& command) -> std::optional<LinearSystem> {
             const auto& loops = made.linearisation.margins;
             const auto found = std::ranges::find(loops, command, &model::LoopMargins::command);
             if (found == loops.end()) return {};
             return found->open;
           })
      .def("json", [](const Linearized& made) { return api::file_text(made, ".json"); })
      .def("report", [](const Linearized& made) { return to_text(api::report_of(made)); });
  module.def("frequencies", &model::frequencies_to_look_at, py::arg("poles"), py::arg("closed"),
             py::arg("period"));
  module.def("linearize", &linearize, py::arg("given"), py::arg("kind"), py::arg("at"));
}

using api::Environments;

std::unique_ptr<Environments> environments(const Given& given, std::size_t count,
                                           std::vector<std::string> keys, bool keeps_rows) {
  return std::make_unique<Environments>(family_of(given), count, std::move(keys), keeps_rows);
}

// Runs that begin: their indices, and for each its values as texts and its seed.
struct Beginnings {
  std::vector<std::size_t> which;
  std::vector<Environments::Beginning> how;
};

Beginnings beginnings(std::vector<std::size_t> which, std::vector<std::vector<std::string>> values,
                      const std::vector<std::size_t>& seeds) {
  if (values.size() != which.size() || seeds.size() != which.size()) {
    throw py::value_error("found lists of different lengths");
  }
  Beginnings all{std::move(which), {}};
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    all.how.push_back({std::move(values[i]), seeds[i]});
  }
  return all;
}

void begin(Environments& its, const Beginnings& these) {
  const WithoutLock unlocked;
  its.begin(these.which, these.how);
}

// Steps the runs that do not begin.
void step(Environments& its, const Numbers& commands, const Beginnings& these) {
  const auto count = static_cast<py::ssize_t>(its.count());
  if (commands.ndim() != 2 || commands.shape(0) != count || commands.shape(1) != 2) {
    throw py::value_error("actions: found another shape; allowed: (" + std::to_string(count) +
                          ", 2)");
  }
  const std::span of(commands.data(), 2 * its.count());
  const WithoutLock unlocked;
  its.step(of, these.which, these.how);
}

void define_environments(py::module_& module) {
  const auto of_each = []<class T>(T (Environments::*of)(std::size_t) const) {
    return [of](const Environments& its) {
      py::array_t<T> all(static_cast<py::ssize_t>(its.count()));
      for (std::size_t i = 0; i < its.count(); ++i) all.mutable_data()[i] = (its.*of)(i);
      return all;
    };
  };
  py::class_<Beginnings>(module, "Beginnings")
      .def(py::init(&beginnings), py::arg("which"), py::arg("values"), py::arg("seeds"));
  py::class_<Environments>(module, "Environments")
      .def(py::init(&environments), py::arg("given"), py::arg("count"), py::arg("keys"),
           py::arg("keeps_rows"))
      .def_property_readonly_static("columns",
                                    [](const py::object& /*type*/) {
                                      std::vector<std::array<std::string, 3>> all;
                                      for (const auto& one : Environments::columns()) {
                                        all.push_back({std::string(one.name), std::string(one.unit),
                                                       std::string(one.meaning)});
                                      }
                                      return all;
                                    })
      .def_property_readonly(
          "command_unit",
          [](const Environments& its) { return command_unit(its.scenario().controller->drives); })
      .def_property_readonly("limits",
                             [](const Environments& its) {
                               const Controller& controller = *its.scenario().controller;
                               return std::pair(controller.limit_of(0), controller.limit_of(1));
                             })
      .def("begin", &begin, py::arg("these"))
      .def("step", &step, py::arg("commands"), py::arg("these"))
      .def_property_readonly("observations",
                             [](const py::object& self) {
                               const auto& its = self.cast<const Environments&>();
                               const auto width =
                                   static_cast<py::ssize_t>(Environments::columns().size());
                               return Column({static_cast<py::ssize_t>(its.count()), width},
                                             its.observations().data(), self);
                             })
      .def_property_readonly("terminated", of_each(&Environments::terminated))
      .def_property_readonly("truncated", of_each(&Environments::truncated))
      .def_property_readonly("costs_of_ending", of_each(&Environments::cost_of_ending))
      .def(
          "result",
          [](Environments& its, std::size_t which) -> std::shared_ptr<api::RunResult> {
            const api::RunResult* const made = which < its.count() ? its.result(which) : nullptr;
            return made == nullptr ? nullptr : std::make_shared<api::RunResult>(*made);
          },
          py::arg("which"))
      .def_property_readonly("in_lanes", &Environments::in_lanes);
}

void raise(const char* type, const py::object& argument) {
  const py::object its = py::module_::import("bbsim._errors").attr(type);
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
  py::register_exception_translator(translate);
  end_work_with_the_interpreter();
  py::class_<Given>(module, "Given")
      .def(py::init([](std::string name, std::optional<std::string> text,
                       std::vector<std::string> overrides, py::object callable) {
             return Given{
                 std::move(name), std::move(text), std::move(overrides), std::move(callable), {}};
           }),
           py::arg("name"), py::arg("text"), py::arg("overrides"), py::arg("callable"))
      .def_property_readonly("name",
                             [](const Given& given) { return shared_family(given).source().file; })
      .def("changed", &changed, py::arg("settings"));
  define_sample(module);
  define_run(module);
  define_sweep(module);
  define_simulate(module);
  define_linearize(module);
  define_environments(module);
  define_results(module);
  define_analysis(module);
  define_pages(module);
  module.def("check", &check, py::arg("given"));
  module.def("number_at", &number_at, py::arg("given"), py::arg("key"), py::arg("value"));
  module.def("accuracy", &accuracy, py::arg("given"), py::arg("rtols"));
  module.def(
      "key_and_hint",
      [](const std::string& message) {
        const bbsim::api::KeyAndHint found = bbsim::api::key_and_hint(message);
        return std::pair(found.key, found.hint);
      },
      py::arg("message"));
}
