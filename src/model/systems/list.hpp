// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The list of all systems, for models and integrators, and what they ask of any of them.
#pragma once

#include <type_traits>
#include <utility>
#include <variant>

#include "model/systems/coupled.hpp"
#include "model/systems/rig_loop.hpp"
#include "model/systems/system.hpp"

namespace bbsim::model {

template <class Signals>
using SystemList = std::variant<OpenLoop<Shape::full, Signals>,     //
                                OpenLoop<Shape::along_x, Signals>,  //
                                OpenLoop<Shape::along_y, Signals>,
                                ClosedLoop<Shape::full, Drives::acceleration, Signals>,
                                ClosedLoop<Shape::along_x, Drives::acceleration, Signals>,
                                ClosedLoop<Shape::along_y, Drives::acceleration, Signals>,
                                ClosedLoop<Shape::full, Drives::angle, Signals>,
                                ClosedLoop<Shape::along_x, Drives::angle, Signals>,
                                ClosedLoop<Shape::along_y, Drives::angle, Signals>,
                                OpenLoop<Shape::full, Signals, GeneralRolling>,  //
                                RigLoop<false, Signals>,                         //
                                RigLoop<true, Signals>,                          //
                                CoupledGiven<Signals>,                           //
                                CoupledLoop<Signals>,                            //
                                CoupledGiven<Signals, true>,                     //
                                CoupledLoop<Signals, Linkages>,                  //
                                CoupledLoop<Signals, ThreeServos>>;

using System = SystemList<SignalPair>;
using SystemViews = SystemList<SignalView>;

// Whether each system's view is at the same position in the list of views.
template <class... Systems, class... Views>
consteval bool views_in_order(std::type_identity<std::variant<Systems...>>,
                              std::type_identity<std::variant<Views...>>) {
  return (std::is_same_v<decltype(std::declval<const Systems&>().view()), Views> && ...);
}
static_assert(views_in_order(std::type_identity<System>{}, std::type_identity<SystemViews>{}));

// The exact Jacobian, by forward-mode automatic differentiation: writes d f_i / d z_j at (t, z) to
// matrix[i + size j] for a system of `size` states. Allocates nothing.
void jacobian(const System& system, double t, const double* z, double* matrix);

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
