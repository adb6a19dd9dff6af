// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Builds the rig of a scene with a controller.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "model/assemble.hpp"
#include "model/control/derivatives.hpp"
#include "model/control/riccati.hpp"
#include "model/servo/linkages.hpp"
#include "model/servo/servo.hpp"
#include "scenario/columns.hpp"

namespace bbsim::model {
namespace {

ServoResponses servo_responses(const Scenario& scene) {
  if (!scene.gimbal.servo) return {};
  ServoResponses all(response_of(scene.gimbal.servo_of(0), *scene.controller));
  all.of[1] = response_of(scene.gimbal.servo_of(1), *scene.controller);
  if (scene.gimbal.three_servos)
    all.of[2] = response_of(scene.gimbal.servo_of(2), *scene.controller);
  return all;
}

ControlLaw control_law(const Scenario& scene, const ServoResponses& servo,
                       const PlantOf& plant_of) {
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
    case Law::commands:
      law.kind = LawKind::played;
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
  rig.mechanism = mechanism_of(scene);
  if (rig.mechanism.three) rig.servos = 3;
  rig.steps_lost = scene.events.steps_lost.value_or(OnEvent::note);
  const Mounting& mounting = scene.gimbal.mounting;
  for (int i = 0; i < rig.servos; ++i) {
    RigServo& servo = rig.servo[i];
    if (scene.gimbal.servo)
      servo = rig_servo(scene.gimbal.servo_of(static_cast<std::size_t>(i)), controller);
    // A linkage includes the plane's offset.
    if (rig.mechanism.none()) servo.offset = i == 0 ? mounting.phi_offset : mounting.theta_offset;
  }
  CommandRange limits[2];
  for (int i = 0; i < 2; ++i) {
    const CommandRange reach = rig.mechanism.reach(i);
    limits[i] = CommandRange::within(
        command_limit(controller, static_cast<std::size_t>(i)).value_or(unlimited));
    limits[i] = {std::max(limits[i].low, reach.low), std::min(limits[i].high, reach.high)};
  }
  // A ball in a groove needs one axis only, so the other gets no command.
  if (controller.sampling && scene.ball.groove) limits[1 - scene.ball.groove->axis] = {0, 0};
  if (controller.sampling) {
    rig.sampled.emplace(SampledLoop{*controller.sampling,
                                    controller.sensor.value_or(Sensor{}),
                                    law,
                                    {limits[0], limits[1]},
                                    rig.mechanism,
                                    {},
                                    controller.drives == Drives::legs});
    if (rig.sampled->sensor.contact_force > 0) rig.sampled->pressing = constants_of(scene);
    if (controller.own) rig.sampled->own_columns = scenario::own_columns(scene);
  } else {
    for (int i = 0; i < 2; ++i) {
      rig.command_limit[i] = limits[i];
      if (law.kind == LawKind::gravity_compensation) {
        rig.command_limit[i] = {std::sin(limits[i].low), std::sin(limits[i].high)};
      }
    }
  }
  return rig;
}

}  // namespace

bool needs_rig(const Scenario& scene) {
  if (!scene.controller) return false;
  const Controller& controller = *scene.controller;
  return controller.law != Law::pd || controller.limit || controller.axis_limits ||
         controller.sampling || scene.gimbal.theta_servo ||
         (scene.gimbal.servo && !scene.gimbal.servo->plain()) || !is_the_papers(scene);
}

std::optional<double> command_limit(const Controller& controller, std::size_t axis) {
  const std::optional<double> limit = controller.limit_of(axis);
  if (limit || controller.law != Law::gravity_compensation) return limit;
  return std::numbers::pi / 4;  // near 90 degrees the inverted sine has no reserve
}

bool integrates_error(const Scenario& scene) {
  return scene.controller && scene.controller->law == Law::pid && !scene.controller->sampling;
}

namespace {

// The rig's mechanism, including servos that turn the plane directly.
template <class Link>
Link link_of(const Rig& rig) {
  Link link;
  if constexpr (std::is_same_v<Link, ThreeServos>) link = *rig.mechanism.three;
  if constexpr (std::is_same_v<Link, Linkages>) {
    link = rig.mechanism.at_home();
    // A direct drive has only the plane's offset.
    for (int i = 0; rig.mechanism.none() && i < 2; ++i) {
      link.of[i].set_offsets(rig.servo[i].offset, 0);
    }
  }
  return link;
}

}  // namespace

template <bool integrates, class Link>
AssembledRig<integrates, Link> assemble_rig(const Scenario& scene, SignalPair reference,
                                            const PlantOf& plant) {
  const ServoResponses servo = servo_responses(scene);
  const PlantOf ideal = [&scene](const ServoResponses& behind) {
    return plant_at_home(
        RigLoop<true>(scene.ball.radius, scene.gravity, general_rolling(scene), {}, behind, {}));
  };
  const ControlLaw law = control_law(scene, servo, plant ? plant : ideal);
  Rig rig = build_rig(scene, law);
  const ControlLaw continuous = rig.sampled ? ControlLaw{} : law;
  const Link link = link_of<Link>(rig);
  RigMode mode;
  for (int i = 0; i < rig.servos; ++i) mode.driver[i].rings = rig.servo[i].rings;
  for (int i = 0; i < 2; ++i) {
    if (!Link::direct) rig.servo[i].offset = 0;  // the link includes it
    mode.axis[i].offset = rig.servo[i].offset;
  }
  return {RigLoop<integrates, SignalPair, Link>(scene.ball.radius, scene.gravity,
                                                general_rolling(scene), continuous, servo,
                                                std::move(reference), mode, link),
          rig};
}

template AssembledRig<false> assemble_rig<false>(const Scenario&, SignalPair, const PlantOf&);
template AssembledRig<true> assemble_rig<true>(const Scenario&, SignalPair, const PlantOf&);
template AssembledRig<true, Linkages> assemble_rig<true, Linkages>(const Scenario&, SignalPair,
                                                                   const PlantOf&);
template AssembledRig<true, ThreeServos> assemble_rig<true, ThreeServos>(const Scenario&,
                                                                         SignalPair,
                                                                         const PlantOf&);

}  // namespace bbsim::model
