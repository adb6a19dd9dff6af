// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A Python callable as the controller of a scene.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "scenario/scenario.hpp"
#include "watch.hpp"

namespace bbsim::python {

// Must outlive the runs that it controls. Create and destroy it with the interpreter's lock.
class Callable {
 public:
  explicit Callable(py::object function);

  // For runs under `watch`, which end if the callable raises. Needs no lock.
  [[nodiscard]] ControllerFactory factory(Watch& watch);

  // Raises what the callable raised: an Exception as the cause of a ControllerError, others (such
  // as KeyboardInterrupt) unchanged.
  void throw_if_raised();

 private:
  class Controller;

  py::object function_;
  std::string name_;  // in messages
  std::optional<py::error_already_set> raised_;
  std::string fault_;
};

}  // namespace bbsim::python
