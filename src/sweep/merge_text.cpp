// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sweep/merge_text.hpp"

#include <algorithm>

#include "base/error.hpp"

namespace bbsim::sweep {

void check_case(const std::string& file, std::size_t found, std::size_t expected) {
  if (found == expected) return;
  throw InputError(file + ": found case " + std::to_string(found) + " where case " +
                   std::to_string(expected) +
                   " should come; allowed: every case of the sweep once");
}

void check_all_there(std::size_t found, std::size_t expected) {
  if (found == expected) return;
  throw InputError("found " + std::to_string(found) + " cases of " + std::to_string(expected) +
                   "; allowed: all parts of the sweep");
}

void InstructionSets::add(const std::string& name) {
  const auto place = std::lower_bound(names_.begin(), names_.end(), name);
  if (place == names_.end() || *place != name) names_.insert(place, name);
}

std::string InstructionSets::names() const {
  std::string list;
  for (const std::string& name : names_) list += (list.empty() ? "" : " and ") + name;
  return list;
}

std::string InstructionSets::note() const {
  if (names_.size() < 2) return "";
  return "the parts are of " + names() + ": alike within the tolerance, not bit for bit";
}

}  // namespace bbsim::sweep
