// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The modes of contact and motors in a coupled scene, and the places of its states.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <type_traits>
#include <variant>

#include "model/hybrid/switched_model.hpp"

namespace bbsim::model {

struct DryScene {
  ContactMode* contact;
  const CoupledBall* ball;
  MotorMode* motors = nullptr;  // null if no torques move the gimbal
  MotorLaw law{};
  std::size_t slip = 0, angle = 0, rate = 0, integral = 0;  // of states; the motors' integrals

  // Points into `model`.
  [[nodiscard]] static DryScene of(SwitchedModel& model) {
    return std::visit(
        [](auto& any) -> DryScene {
          using Any = std::decay_t<decltype(any)>;
          if constexpr (is_coupled<Any>) {
            DryScene scene{&any.parts.contact, &any.parts.ball};
            scene.slip = Any::Layout::slip;
            if constexpr (is_coupled_loop<Any>) {
              if (any.by != GimbalBy::servos) scene.motors = any.motors;
              scene.law = any.motor;
              scene.angle = Any::Layout::angle;
              scene.rate = Any::Layout::rate;
              scene.integral = Any::Layout::motor;
            }
            return scene;
          } else {
            throw std::logic_error("dry switches of a scene without them");
          }
        },
        model.get().system);
  }
};

}  // namespace bbsim::model
