// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A model in its present mode, as the parts that switch see it.
#pragma once

#include <stdexcept>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "base/pair.hpp"
#include "model/model.hpp"

namespace bbsim::model {

// Demands of the law and of the servos.
struct Demands {
  Pair raw, command;                                       // of the law, before and after its limit
  double servo_command[most_servos], demand[most_servos];  // rad, rad/s^2
};

// The rates of the law's commands, in their unit per second.
struct CommandRates {
  Pair raw, shown;  // before the limit, while the integrals wait; and at the motors
};

class SwitchedModel {
 public:
  // Index of the first servo's angle in the states.
  static constexpr std::size_t angle = RigLayout::angle;

  explicit SwitchedModel(const Model& model);
  SwitchedModel(const SwitchedModel&) = delete;  // the mode is a part of this object
  SwitchedModel& operator=(const SwitchedModel&) = delete;

  [[nodiscard]] Model& get() { return model_; }
  [[nodiscard]] const Model& get() const { return model_; }
  // For scenes with a rig only.
  [[nodiscard]] const Rig& rig() const { return *model_.rig; }
  [[nodiscard]] RigMode& mode() { return *mode_; }
  [[nodiscard]] const RigMode& mode() const { return *mode_; }
  // Index of the first servo's rate in the states.
  [[nodiscard]] std::size_t rate() const { return rate_; }

  // Calls `use` with the model's RigLoop.
  template <class Use>
  auto with_loop(Use use) const {
    using Result = decltype(use(std::declval<const RigLoop<>&>()));
    // The most common rig first, because each sample calls this several times.
    if (const auto* const plain = std::get_if<RigLoop<>>(&model_.system)) return use(*plain);
    return std::visit(
        [&](const auto& any) -> Result {
          const auto* const loop = rig_loop_of(any);
          if (loop == nullptr) throw std::logic_error("a rig of a scene without a controller");
          return use(*loop);
        },
        model_.system);
  }

  // The angle and rate that the firmware knows of a servo: of a shaft that rings, those that its
  // driver counts.
  struct ServoReading {
    double angle, rate;
  };
  [[nodiscard]] ServoReading counted(std::size_t servo, double t, const double* z) const {
    if (!mode_->rings || !mode_->driver[servo].rings) return {z[angle + servo], z[rate_ + servo]};
    const Jet<double> counted = mode_->driver[servo].counted(t);
    return {counted.value, counted.rate};
  }
  [[nodiscard]] Demands demands(double t, const double* z) const;
  [[nodiscard]] CommandRates command_rates(double t, const double* z) const;
  // The forces of a coupled scene.
  [[nodiscard]] Balance<double> balance(double t, const double* z) const;
  // The plane's angles and rates.
  [[nodiscard]] RigExtras plane(const double* z) const {
    return with_loop([z](const auto& loop) { return loop.plane(z); });
  }
  [[nodiscard]] Sample sample(double t, const double* z, Detail detail) const {
    return std::visit([&](const auto& system) { return system.sample(t, z, detail); },
                      model_.system);
  }

 private:
  Model model_;
  RigMode* mode_ = nullptr;  // of the model's system, if it has a rig
  std::size_t rate_ = RigLayout::rate;
  mutable std::vector<double> rates_;  // of the states
};

// Modes of the contact and the motors in a coupled scene, and indices of its states.
struct DryScene {
  ContactMode* contact;
  const CoupledBall* ball;
  MotorMode* motors = nullptr;  // null if no torques move the gimbal
  MotorLaw law{};
  std::size_t slip = 0, angle = 0, rate = 0, integral = 0;  // integral: the motors'

  // The result points into `model`.
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
