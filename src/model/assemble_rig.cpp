#include "model/assemble_rig.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "model/control/sampled_cycle.hpp"
#include "scenario/columns.hpp"

namespace bbsim::model {
namespace {

ServoResponse servo_response(const Scenario& scene) {
  if (!scene.gimbal.servo) return {};
  const Servo& servo = *scene.gimbal.servo;
  if (servo.time_constant) return {0, 0, 1 / *servo.time_constant};
  const double w = servo.natural_frequency;
  return {w * w, w * w, 2 * servo.damping * w};
}

ControlLaw control_law(const Scenario& scene, const ServoResponse& servo, const PlantOf& plant_of) {
  const Controller& controller = *scene.controller;
  ControlLaw law;
  law.kind = LawKind::linear;
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t j = 0; j < 2; ++j) {
      law.kp[i][j] = law.gain[i][j] = controller.kp[i][j];
      law.kv[i][j] = law.gain[i][2 + j] = controller.kv[i][j];
      law.integral[i][j] = controller.ki[i][j];
    }
  }
  switch (controller.law) {
    case Law::pd:
    case Law::pid:
      break;
    case Law::state_feedback:
      for (std::size_t i = 0; i < 2; ++i) {
        std::copy(controller.gain[i].begin(), controller.gain[i].end(), law.gain[i]);
      }
      break;
    case Law::lqr: {
      const double period = controller.sampling ? controller.sampling->period : 0;
      const auto gain = lqr_gain(plant_of(servo), controller.weights, period);
      for (int i = 0; i < 2; ++i) {
        for (int j = 0; j < 8; ++j) law.gain[i][j] = gain(i, j);
      }
      break;
    }
    case Law::gravity_compensation:
      law.kind = LawKind::gravity_compensation;
      law.scale = (1 + scene.ball.inertia_factor) / scene.gravity;
      break;
    case Law::feedback_linearisation:
      law.kind = LawKind::feedback_linearisation;
      break;
    case Law::own:
      law.kind = LawKind::held;
      break;
  }
  return law;
}

Rig build_rig(const Scenario& scene, const ControlLaw& law) {
  const Controller& controller = *scene.controller;
  Rig rig;
  rig.offset = {scene.gimbal.mounting.phi_offset, scene.gimbal.mounting.theta_offset};
  if (scene.gimbal.servo) {
    const Servo& servo = *scene.gimbal.servo;
    rig.angle_limit = servo.angle_limit.value_or(unlimited);
    rig.rate_limit = servo.rate_limit.value_or(unlimited);
    rig.acceleration_limit = servo.acceleration_limit.value_or(unlimited);
    rig.dead_band = servo.dead_band;
    rig.backlash = servo.backlash;
    rig.time_constant = servo.time_constant;
  }
  const bool compensates = law.kind == LawKind::gravity_compensation;
  const double limit = command_limit(controller).value_or(unlimited);
  if (controller.sampling) {
    rig.sampled =
        SampledLoop{*controller.sampling, controller.sensor.value_or(Sensor{}), law, limit};
    if (controller.own) rig.sampled->own_columns = scenario::own_columns(scene);
  } else {
    rig.command_limit = compensates ? std::sin(limit) : limit;
  }
  return rig;
}

}  // namespace

bool needs_rig(const Scenario& scene) {
  if (!scene.controller) return false;
  const Controller& controller = *scene.controller;
  return controller.law != Law::pd || controller.limit || controller.sampling ||
         (scene.gimbal.servo && !scene.gimbal.servo->plain()) || !is_the_papers(scene);
}

std::optional<double> command_limit(const Controller& controller) {
  if (controller.limit || controller.law != Law::gravity_compensation) return controller.limit;
  return std::numbers::pi / 4;  // beyond it the sine that is inverted soon has nothing left to give
}

bool integrates_error(const Scenario& scene) {
  return scene.controller && scene.controller->law == Law::pid && !scene.controller->sampling;
}

template <bool integrates>
AssembledRig<integrates> assemble_rig(const Scenario& scene, SignalPair reference,
                                      const PlantOf& plant) {
  const ServoResponse servo = servo_response(scene);
  const PlantOf ideal = [&scene](const ServoResponse& behind) {
    return linear_plant(
        RigLoop<>(scene.ball.radius, scene.gravity, general_rolling(scene), {}, behind, {}));
  };
  const ControlLaw law = control_law(scene, servo, plant ? plant : ideal);
  Rig rig = build_rig(scene, law);
  const ControlLaw continuous = rig.sampled ? ControlLaw{} : law;
  RigMode mode;
  for (std::size_t i = 0; i < 2; ++i) mode.axis[i].offset = rig.offset[i];
  return {RigLoop<integrates>(scene.ball.radius, scene.gravity, general_rolling(scene), continuous,
                              servo, std::move(reference), mode),
          rig};
}

template AssembledRig<false> assemble_rig<false>(const Scenario&, SignalPair, const PlantOf&);
template AssembledRig<true> assemble_rig<true>(const Scenario&, SignalPair, const PlantOf&);

}  // namespace bbsim::model
