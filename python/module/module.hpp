// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What the parts of the module share: a scenario as the Python package names it, arrays, the
// attributes of bound types, and callables. Only the package calls what is bound, so arguments have
// no names.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "scenario/family.hpp"
#include "scenario/scenario.hpp"
#include "watch.hpp"

namespace bbsim::python {

using Texts = std::vector<std::string>;
using Pairs = std::vector<std::pair<std::string, std::string>>;
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

// A file, or a text with a name for messages.
struct Given {
  std::string name;
  std::optional<std::string> text;  // if empty: the file `name`
  Texts overrides;
  py::object callable;  // or None
  // Read once for all calls of simulate(), which a fit calls often. Needs the interpreter's lock.
  mutable std::shared_ptr<const ScenarioFamily> family{};
};

inline ScenarioFamily family_of(const Given& given) {
  if (!given.text) return ScenarioFamily(given.name, given.overrides);
  return ScenarioFamily(Source{given.name, *given.text, given.overrides});
}

// Reads it only once, without its callable. Call it with the interpreter's lock.
inline const ScenarioFamily& shared_family(const Given& given) {
  if (!given.family) given.family = std::make_shared<const ScenarioFamily>(family_of(given));
  return *given.family;
}

// The scenario with more settings. Standard input is not read again.
inline Given changed(const Given& given, const Pairs& settings) {
  const Source& source = shared_family(given).source();
  Given more{given.name, source.text, source.overrides, given.callable, {}};
  for (const auto& [key, value] : settings) more.overrides.push_back(key + '=' + value);
  return more;
}

inline std::vector<double> list_of(const Numbers& numbers) {
  return {numbers.data(), numbers.data() + numbers.size()};
}

// An array on memory of `owner`, which the array keeps alive.
inline py::array_t<double> view(const std::vector<double>& values, const py::object& owner) {
  return {{static_cast<py::ssize_t>(values.size())}, {sizeof(double)}, values.data(), owner};
}

// Binds attributes of a type: for each, its name and a member, a method, or a function of the
// object. A member of numbers is an array on the object's memory.
template <class Bound, class Its, class... Rest>
Bound attributes(Bound bound, const char* name, Its its, Rest... rest) {
  using Type = typename Bound::type;
  if constexpr (std::is_same_v<Its, std::vector<double> Type::*>) {
    bound.def_property_readonly(
        name, [its](const py::object& self) { return view(self.cast<const Type&>().*its, self); });
  } else if constexpr (std::is_member_object_pointer_v<Its>) {
    bound.def_readonly(name, its);
  } else {
    bound.def_property_readonly(name, its);
  }
  if constexpr (sizeof...(rest) > 0) attributes(bound, rest...);
  return bound;
}

// A Python callable as the controller of a scene. Must outlive the runs that it controls. Create
// and destroy it with the interpreter's lock.
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

void define_sample(py::module_& module);   // the argument of a callable
void define_results(py::module_& module);  // stored results, pages of them, files written whole
// A scenario's keys, tables, measures, drawn cases.
void define_analysis(py::module_& module, py::class_<Given>& given);

}  // namespace bbsim::python
