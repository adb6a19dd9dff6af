// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Rigs whose servos alone move the plate and the ball.
#pragma once

#include <type_traits>
#include <variant>

#include "model/model.hpp"

namespace bbsim::model {

// Calls `use` with the RigLoop of a system if the servos' motion determines the plate's, and that
// the ball's: the ball rolls without losses and without a push. Otherwise returns false.
template <class Use>
bool with_given_plate(const System& system, Use use) {
  return std::visit(
      [&](const auto& any) {
        using Any = std::decay_t<decltype(any)>;
        if constexpr (std::is_same_v<Any, RigLoop<false>>) {
          use(any);
          return true;
        } else if constexpr (is_coupled_loop<Any>) {
          if constexpr (Any::pushes) {
            if (any.by != GimbalBy::servos || any.parts.ball.law != ContactLaw{} ||
                !any.push.on.is_zero(0) || !any.push.on.is_zero(1)) {
              return false;
            }
            use(any.loop);
            return true;
          }
        }
        return false;
      },
      system);
}

}  // namespace bbsim::model
