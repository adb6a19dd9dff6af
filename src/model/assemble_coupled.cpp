#include "model/assemble_coupled.hpp"

#include <algorithm>
#include <utility>

#include "model/assemble_rig.hpp"
#include "model/control/sampled_cycle.hpp"
#include "scenario/coupled.hpp"

namespace bbsim::model {
namespace {

CoupledParts coupled_parts(const Scenario& scene) {
  CoupledParts parts;
  parts.ball = coupled_ball(scene);
  return parts;
}

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
    const DcMotor& dc = *motor.dc;
    const double torque_by_current = dc.gear * dc.torque_constant;
    law.from_command = torque_by_current / dc.resistance;
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
  if (motor.dc && motor.dc->voltage_limit) {
    const double torque_by_current = motor.dc->gear * motor.dc->torque_constant;
    dry.stall_torque = torque_by_current * *motor.dc->voltage_limit / motor.dc->resistance;
    dry.torque_by_rate = torque_by_current * torque_by_current / motor.dc->resistance;
  }
  return dry;
}

}  // namespace

CoupledBall coupled_ball(const Scenario& scene) {
  const Ball& ball = scene.ball;
  CoupledBall coupled;
  coupled.r = ball.radius;
  coupled.m = ball.mass;
  coupled.g = scene.gravity;
  coupled.rolling = general_rolling(scene);
  coupled.law.rolling = ball.losses.rolling;
  coupled.law.viscous = ball.losses.viscous / (ball.mass * ball.radius * ball.radius);
  coupled.law.pivoting = ball.losses.pivoting / ball.radius;
  if (scene.events.slip) coupled.law.sliding = scene.events.slip->sliding.value_or(0);
  if (scene.plate.inertia) std::ranges::copy(*scene.plate.inertia, coupled.body.plate);
  coupled.body.imbalance = scene.plate.mass * scene.plate.centre_of_mass;
  coupled.body.ring = scene.gimbal.ring_inertia;
  if (scene.gimbal.motor) coupled.body.rotor = scene.gimbal.motor->rotor_inertia;
  return coupled;
}

CoupledScene assemble_coupled(const Scenario& scene, SignalPair input) {
  const CoupledParts parts = coupled_parts(scene);
  const DryParts dry = dry_parts(scene);
  CoupledScene result{CoupledGiven<>(parts, {}), {}, {}};
  if (dry.switches()) result.dry = dry;
  if (scene.gimbal.motion) {
    result.system = CoupledGiven<>(parts, std::move(input));
    return result;
  }
  const bool torques = scenario::moved_by_torques(scene);
  if (!scene.controller) {
    RigMode mode;
    mode.axis[0].offset = scene.gimbal.mounting.phi_offset;
    mode.axis[1].offset = scene.gimbal.mounting.theta_offset;
    const RigLoop<true> control(scene.ball.radius, scene.gravity, parts.ball.rolling, {}, {},
                                std::move(input), mode);
    result.system = CoupledLoop<>(parts, GimbalBy::given_torques, motor_law(scene), control);
    return result;
  }
  const GimbalBy by = torques ? GimbalBy::torques : GimbalBy::servos;
  const MotorLaw motor = torques ? motor_law(scene) : MotorLaw{};
  const auto plant = [&](const ServoResponse& servo) {
    const RigLoop<true> held(scene.ball.radius, scene.gravity, parts.ball.rolling, {}, servo, {});
    return linear_plant(CoupledLoop<>(parts, by, motor, held));
  };
  AssembledRig<true> assembled = assemble_rig<true>(scene, std::move(input), plant);
  CoupledLoop<> loop(parts, by, motor, assembled.loop);
  loop.integrate_error(integrates_error(scene));
  result.system = std::move(loop);
  result.rig = assembled.rig;
  return result;
}

std::vector<double> initial_coupled_state(const Scenario& scene) {
  const Ball& ball = scene.ball;
  const double r = ball.radius;
  std::vector<double> z{ball.position[0], ball.position[1], ball.velocity[0], ball.velocity[1],
                        r * ball.spin};
  std::size_t slip = CoupledGivenLayout::slip, size = CoupledGivenLayout::states;
  if (!scene.gimbal.motion) {
    const GimbalStart& start = scene.gimbal.start;
    z.insert(z.end(), {start.phi, start.theta, start.phi_rate, start.theta_rate});
    slip = CoupledLoopLayout::slip;
    size = CoupledLoopLayout::states;
  }
  z.resize(size, 0.0);
  if (ball.rotation) {
    z[slip] = ball.velocity[0] - r * (*ball.rotation)[1];
    z[slip + 1] = ball.velocity[1] + r * (*ball.rotation)[0];
  }
  return z;
}

}  // namespace bbsim::model
