// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Builds the systems of scenes with couples, sliding, pushes or torques.
#include <type_traits>
#include <utility>

#include "model/assemble.hpp"
#include "model/control/derivatives.hpp"
#include "scenario/coupled.hpp"

namespace bbsim::model {
namespace {

MotorLaw motor_law(const Scenario& scene) {
  const Motor motor = scene.gimbal.motor.value_or(Motor{});
  MotorLaw law;
  law.from_command = 1;
  law.viscous = motor.viscous;
  law.friction = motor.friction;
  if (motor.position_loop) {
    law.from_command = law.from_angle = motor.position_loop->kp;
    law.from_rate = motor.position_loop->kd;
    law.from_integral = motor.position_loop->ki;
  } else if (scene.controller && scene.controller->drives == Drives::voltage) {
    const auto [resistance, torque_by_current] = constants_of(scene).armature;
    law.from_command = torque_by_current / resistance;
    law.from_rate = torque_by_current * law.from_command;
  }
  return law;
}

DryParts dry_parts(const Scenario& scene) {
  DryParts dry;
  const Losses& losses = scene.ball.losses;
  dry.rolling = losses.rolling > 0;
  dry.pivoting = losses.pivoting > 0;
  if (scene.events.slip && scene.events.slip->sliding) {
    dry.slides = true;
    dry.static_friction = scene.events.slip->friction;
  }
  dry.rest = scene.events.rest;
  dry.stick = scene.events.stick;
  if (!scene.gimbal.motor || !scenario::moved_by_torques(scene)) return dry;
  const Motor& motor = *scene.gimbal.motor;
  dry.friction = motor.friction;
  dry.torque_limit = motor.torque_limit.value_or(unlimited);
  dry.integrates = motor.position_loop && motor.position_loop->ki > 0;
  if (motor.dc && motor.dc->voltage_limit) {
    const auto [resistance, torque_by_current] = constants_of(scene).armature;
    dry.stall_torque = torque_by_current * *motor.dc->voltage_limit / resistance;
    dry.torque_by_rate = torque_by_current * torque_by_current / resistance;
  }
  return dry;
}

}  // namespace

CoupledBall coupled_ball(const Scenario& scene) {
  const BallConstants of = constants_of(scene);
  const ContactLaw law(scene.ball.losses, scene.ball.mass, scene.ball.radius);
  CoupledBall coupled{of.radius, of.mass, of.gravity, of.rolling, law, of.body};
  if (scene.events.slip) coupled.law.sliding = scene.events.slip->sliding.value_or(0);
  return coupled;
}

namespace {

SignalPair push_on(const Scenario& scene) {
  SignalPair push;
  if (scene.ball.push) {
    push.add(0, scene.ball.push->x);
    push.add(1, scene.ball.push->y);
  }
  return push;
}

// The loop for prescribed torques.
template <class Link>
RigLoop<true, SignalPair, Link> torque_loop(const Scenario& scene, const CoupledParts& parts,
                                            SignalPair input) {
  const Mounting& mounting = scene.gimbal.mounting;
  const double offset[2] = {mounting.phi_offset, mounting.theta_offset};
  RigMode mode;
  Link link;
  for (int i = 0; i < 2; ++i) {
    if constexpr (std::is_same_v<Link, Linkages>) {
      link.of[i].set_offsets(offset[i], 0);
    } else {
      mode.axis[i].offset = offset[i];
    }
  }
  return {
      scene.ball.radius, scene.gravity, parts.ball.rolling, {}, {}, std::move(input), mode, link};
}

template <class Link>
CoupledScene coupled_loop(const Scenario& scene, const CoupledParts& parts, SignalPair input) {
  using Loop = CoupledLoop<SignalPair, Link>;
  typename Loop::template PushOf<SignalPair> push;
  if constexpr (Loop::pushes) push.on = push_on(scene);
  const bool torques = scenario::moved_by_torques(scene);
  if constexpr (Link::servos == 2) {
    if (!scene.controller) {
      return {Loop(parts, GimbalBy::given_torques, motor_law(scene),
                   torque_loop<Link>(scene, parts, std::move(input)), push)};
    }
  }
  const GimbalBy by = torques ? GimbalBy::torques : GimbalBy::servos;
  const MotorLaw motor = torques ? motor_law(scene) : MotorLaw{};
  // LQR gains apply to the plane's angles, so the plant has no linkage.
  const auto plant = [&](const ServoResponses& servo) {
    const RigLoop<true> held(scene.ball.radius, scene.gravity, parts.ball.rolling, {}, servo, {});
    return plant_at_home(CoupledLoop<>(parts, by, motor, held));
  };
  AssembledRig<true, Link> assembled = assemble_rig<true, Link>(scene, std::move(input), plant);
  Loop loop(parts, by, motor, assembled.loop, push);
  loop.integrate_error(integrates_error(scene));
  return {std::move(loop), assembled.rig};
}

}  // namespace

CoupledScene assemble_coupled(const Scenario& scene, SignalPair input) {
  const CoupledParts parts{coupled_ball(scene)};
  const DryParts dry = dry_parts(scene);
  const auto without_dry = [&]() -> CoupledScene {
    if (scene.gimbal.motion) {
      if (!scene.ball.push) return {CoupledGiven<>(parts, std::move(input))};
      return {CoupledGiven<SignalPair, true>(parts, std::move(input), {push_on(scene)})};
    }
    if (scene.gimbal.three_servos) return coupled_loop<ThreeServos>(scene, parts, std::move(input));
    if (scene.ball.push || scenario::is_linked(scene)) {
      return coupled_loop<Linkages>(scene, parts, std::move(input));
    }
    return coupled_loop<Direct>(scene, parts, std::move(input));
  };
  CoupledScene result = without_dry();
  if (dry.switches()) result.dry = dry;
  return result;
}

std::vector<double> push_knots(const Scenario& scene) {
  return push_on(scene).knots();
}

}  // namespace bbsim::model
