// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Adds a profile's terms to a sum of signals.
#pragma once

#include <type_traits>
#include <variant>

#include "scenario/scenario.hpp"

namespace bbsim::model {

// Adds a profile's constants, sinusoids and ramps to `to`, with add_constant(component, ...) and so
// on. Passes all other terms, which lanes share (SharedTerms), to add_shared(part).
template <class Signals, class Component, class AddShared>
void add_profile(const Profile& profile, Component component, Signals& to, AddShared add_shared) {
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
            add_shared(part);
          }
        },
        term);
  }
}

}  // namespace bbsim::model
