// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/hybrid/modes.hpp"

#include <algorithm>
#include <type_traits>
#include <variant>

namespace bbsim::model {

Modes modes_of(const System& system) {
  Modes modes;
  std::visit(
      [&](const auto& any) {
        using Any = std::decay_t<decltype(any)>;
        if constexpr (is_rig<Any>) modes.rig = any.mode;
        if constexpr (is_coupled<Any>) modes.contact = any.parts.contact;
        if constexpr (is_coupled_loop<Any>) {
          modes.rig = any.loop.mode;
          std::copy_n(any.motors, 2, modes.motors.begin());
        }
      },
      system);
  return modes;
}

void follow_friction(const Modes& modes, System& system) {
  std::visit(
      [&](auto& any) {
        using Any = std::decay_t<decltype(any)>;
        if constexpr (is_coupled<Any>) any.parts.contact = modes.contact;
        if constexpr (is_coupled_loop<Any>) {
          for (std::size_t i = 0; i < modes.motors.size(); ++i) {
            any.motors[i].free = modes.motors[i].free;
            any.motors[i].opposed = modes.motors[i].opposed;
          }
        }
      },
      system);
}

}  // namespace bbsim::model
