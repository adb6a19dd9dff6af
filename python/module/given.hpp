// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A scenario as the Python package names it.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenario/family.hpp"

namespace bbsim::python {

namespace py = pybind11;

// A file, or a text with a name for messages.
struct Given {
  std::string name;
  std::optional<std::string> text;  // if empty: the file `name`
  std::vector<std::string> overrides;
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
inline Given changed(const Given& given,
                     const std::vector<std::pair<std::string, std::string>>& settings) {
  const Source& source = shared_family(given).source();
  Given more{given.name, source.text, source.overrides, given.callable, {}};
  for (const auto& [key, value] : settings) more.overrides.push_back(key + '=' + value);
  return more;
}

}  // namespace bbsim::python
