// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Adds a profile's terms to a sum of signals.
#pragma once

#include <type_traits>
#include <variant>

#include "scenario/scenario.hpp"

namespace bbsim::model {

// Passes constants, sinusoids and ramps to `to`, by add_constant(component, ...) and the like, and
// tables to add_table(table).
template <class Signals, class Component, class AddTable>
void add_profile(const Profile& profile, Component component, Signals& to, AddTable add_table) {
  for (const ProfileTerm& term : profile) {
    std::visit(
        [&](const auto& part) {
          using Part = std::decay_t<decltype(part)>;
          if constexpr (std::is_same_v<Part, double>) {
            to.add_constant(component, part);
          } else if constexpr (std::is_same_v<Part, Sinusoid>) {
            to.add_constant(component, part.offset);
            to.add_sinusoid(component, part.amplitude, part.frequency, part.phase);
          } else if constexpr (std::is_same_v<Part, Ramp>) {
            to.add_ramp(component, part.start, part.rate);
          } else {
            add_table(part);
          }
        },
        term);
  }
}

}  // namespace bbsim::model
