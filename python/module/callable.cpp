// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A Python callable as the controller of a scenario.
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "api/stepped_run.hpp"
#include "base/number_text.hpp"
#include "base/text.hpp"
#include "module.hpp"
#include "scenario/columns.hpp"

namespace bbsim::python {
namespace {

using api::Sample;
using model::ControllerFault;

// `function` may be a function, a bound method or an object.
std::string name_of(const py::object& function) {
  const py::object named =
      py::hasattr(function, "__qualname__") ? function : py::object(py::type::of(function));
  return std::string(py::str(named.attr("__qualname__")));
}

}  // namespace

// With the names of docs/reference/controllers.md.
void define_sample(py::module_& module) {
  const auto of = []<class Member>(Member Sample::*member) {
    return [member](const Sample& sample) -> py::object {
      const py::object list = py::cast(sample.*member);
      return list.is_none() ? list : py::tuple(list);
    };
  };
  const auto of_servos = [](std::array<double, 3> Sample::*member) {
    return [member](const Sample& sample) {
      const double* const all = (sample.*member).data();
      return py::tuple(py::cast(std::vector<double>(all, all + sample.commands)));
    };
  };
  attributes(
      py::class_<Sample>(
          module, "Sample",
          "What a callable controller receives, as attributes and as items: the sample's number, t "
          "(s), ball (m; None if it is not seen), reference, reference_rate, "
          "reference_acceleration (m, s), servo, servo_rate (rad, s)."),
      "sample", &Sample::number, "t", &Sample::t, "ball", of(&Sample::ball), "reference",
      of(&Sample::reference), "reference_rate", of(&Sample::reference_rate),
      "reference_acceleration", of(&Sample::reference_acceleration), "servo",
      of_servos(&Sample::servo), "servo_rate", of_servos(&Sample::servo_rate))
      .def("__getitem__",
           [](const py::object& self, const py::str& name) {
             if (!py::hasattr(self, name)) throw py::key_error(std::string(name));
             return py::object(self.attr(name));
           })
      .def("__repr__", [](const Sample& sample) {
        return "<bbsim.Sample " + std::to_string(sample.number) +
               " at t = " + number_text(sample.t) + " s>";
      });
}

class Callable::Controller : public model::ExternalController {
 public:
  Controller(Callable& callable, Watch& watch, const Scenario& scenario)
      : callable_(callable), watch_(watch), own_(scenario::own_columns(scenario)) {}

  void begin() override {
    ask("to start", [this] {
      if (py::hasattr(callable_.function_, "reset")) callable_.function_.attr("reset")();
    });
  }

  model::Commands command(const model::ControllerSample& at, double* own) override {
    model::Commands command{};
    commands_ = at.servo.size();
    ask("at sample " + std::to_string(at.number) + " (t = " + number_text(at.t) + " s)",
        [&] { read(callable_.function_(api::copy_of(at)), command, own); });
    return command;
  }

 private:
  template <class Question>
  void ask(const std::string& when, const Question& question) {
    with_lock([&] {
      const Watch::WithinCallable within(watch_);
      try {
        question();
      } catch (py::error_already_set& error) {
        const bool interrupted = !error.matches(PyExc_Exception);
        const std::string fault = "the controller (" + callable_.name_ + ") failed " + when + ": " +
                                  std::string(py::str(error.type().attr("__name__"))) + ": " +
                                  std::string(py::str(error.value()));
        if (!callable_.raised_) {
          callable_.raised_.emplace(std::move(error));
          callable_.fault_ = fault;
        }
        watch_.end_soon();
        throw ControllerFault(fault, interrupted);
      }
    });
  }

  void read(const py::object& answer, model::Commands& command, double* own) const {
    const std::size_t most = commands_ + (own_.empty() ? 0 : 1);
    if (!py::isinstance<py::sequence>(answer) || py::len(answer) != most) refuse(answer);
    const auto number = [&](const py::object& value) {
      if (PyNumber_Check(value.ptr()) == 0) refuse(answer);
      const double found = py::float_(value).cast<double>();
      if (!std::isfinite(found)) refuse(answer);
      return found;
    };
    for (std::size_t i = 0; i < commands_; ++i) command[i] = number(answer[py::int_(i)]);
    if (own_.empty()) return;
    const py::object numbers = answer[py::int_(commands_)];
    for (std::size_t i = 0; i < own_.size(); ++i) {
      if (!numbers.contains(own_[i])) refuse(answer);
      own[i] = number(numbers[py::str(own_[i])]);
    }
  }

  [[noreturn]] void refuse(const py::object& answer) const {
    const std::string shown = bbsim::shown(std::string(py::repr(answer)), longest_saying);
    const std::string commands = commands_ == 3 ? "s1, s2, s3" : "phi, theta";
    const std::string text = "its answer was " + shown + "; allowed: (" + commands + "), or (" +
                             commands +
                             ", {\"NAME\": number}) with the names that output.columns asks for";
    PyErr_SetString(PyExc_ValueError, text.c_str());
    throw py::error_already_set();
  }

  Callable& callable_;
  Watch& watch_;
  std::vector<std::string> own_;
  std::size_t commands_ = 2;  // number of commands for a sample
};

Callable::Callable(py::object function)
    : function_(std::move(function)), name_(name_of(function_)) {}

ControllerFactory Callable::factory(Watch& watch) {
  return {"a Python callable: " + name_, [this, &watch](const Scenario& scenario) {
            return std::make_shared<Controller>(*this, watch, scenario);
          }};
}

void Callable::throw_if_raised() {
  if (!raised_) return;
  py::error_already_set error = std::move(*raised_);
  raised_.reset();
  if (!error.matches(PyExc_Exception)) throw error;
  const py::object type = py::module_::import("bbsim._scenario").attr("ControllerError");
  py::raise_from(error, type.ptr(), fault_.c_str());
  throw py::error_already_set();
}

}  // namespace bbsim::python
