// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A scene of every kind: given motions, loops, rigs that switch and sample, losses, torques.
#pragma once

#include <string>
#include <vector>

#include "scenario/reader.hpp"
#include "support/run_in_memory.hpp"

namespace bbsim_test {

struct SceneCase {
  const char* what;
  std::string scene;  // a file of the project, or the text
  std::vector<std::string> changes = {};
  std::size_t events = 0;  // at least
  double apart = 1e-8;     // of two integrators at rtol 1e-10, m
  bool stiff = false;      // Adams would take hundreds of thousands of steps
};

// Without the resolutions of the project's rigs, whose steps would amplify rounding.
inline bbsim::Scenario load(const SceneCase& one) {
  if (one.scene.find('\n') != std::string::npos) {
    return bbsim::parse_scenario(one.scene, "scene.yaml", one.changes);
  }
  bbsim::Scenario scene =
      bbsim::read_scenario(std::string(BBSIM_SOURCE_DIR "/") + one.scene + ".yaml", one.changes);
  if (scene.gimbal.servo) scene.gimbal.servo->dead_band = 0;
  if (scene.controller && scene.controller->sampling) scene.controller->sampling->resolution = 0;
  if (scene.controller && scene.controller->sensor) scene.controller->sensor->resolution = 0;
  return scene;
}

inline const std::string waypoints =
    "points: [[0, 0], [0.06, 0.02], [0.03, 0.07], [-0.04, 0.01]], times: [0.5, 1, 1.5, 2.5]";

inline const std::string ball = "gravity: 9.81\nball: {radius: 0.02, mass: 0.03, position: ";

inline const std::string rocking =
    "gravity: 9.81\nball: {radius: 0.02, mass: 0.05, spin: 3, losses: {rolling: 0.003, pivoting: "
    "1e-4}}\n"
    "gimbal: {motion: {phi: {sinusoid: {amplitude: 0.2, frequency: 7, phase: 1.57}},\n"
    "  theta: {sinusoid: {amplitude: 0.15, frequency: 5, phase: 1.57}}}}\n"
    "time: {end: 5, step: 0.05}\n";

inline const SceneCase scene_cases[] = {
    {"a given motion", "tests/data/scenarios/fig2a"},
    {"a spinning ball", "tests/data/scenarios/spin"},
    {"tables", "configs/recorded"},
    {"a loop", "tests/data/scenarios/fig2b"},
    {"a loop in one plane", "configs/beam"},
    {"a stiff servo", "tests/data/scenarios/stiff-servo", {"time.end=5"}, 0, 1e-8, true},
    {"no servo, a limit",
     "configs/hold",
     {"gimbal.servo=null",
      "controller={lqr: {position: 20, velocity: 1, command: 0.1}, limit: 3, "
      "reference: {point: [0.01, 0]}}"}},
    {"along a figure",
     "configs/hold",
     {"controller.reference={lissajous: {amplitude: [0.05, 0.03], rate: [0.5, 1]}}"}},
    {"along waypoints", "configs/hold", {"controller.reference={waypoints: {" + waypoints + "}}"}},
    {"along waypoints with rests",
     "configs/hold",
     {"controller.reference={waypoints: {" + waypoints + ", rest: true}}"}},
    {"along a table", "configs/traced", {"time.end=4"}},
    {"along a staircase",
     "configs/hold",
     {"controller.reference={staircase: {points: [[0, 0], [0.05, -0.02], [0, 0.03]], times: [0, "
      "2.125, "
      "3]}}"}},
    {"along a square wave, at limits",
     "configs/hold",
     {"controller={pid: {kv: [[0.5, 0], [0, -0.5]], kp: [[0.7, 0], [0, -0.7]], ki: [[0.2, 0], [0, "
      "-0.2]]}, drives: angle, limit: 0.02, reference: {square: {amplitude: [0.04, 0.03], period: "
      "1.5, duty: 0.25}}}"}},
    {"losses", "tests/data/scenarios/losses"},
    {"losses that stop the ball again and again",
     rocking,
     {"gimbal.motion.phi.sinusoid.amplitude=0.004", "gimbal.motion.theta.sinusoid.amplitude=0",
      "events={rest: note}"},
     5},
    {"sliding again and again",
     rocking,
     {"events={slip: {friction: 0.055, sliding_friction: 0.045, action: slide}}"},
     6},
    {"backspin", "configs/slides"},
    {"torques", "tests/data/scenarios/torque-open"},
    {"motors", "tests/data/scenarios/torque-loop", {"time.end=5"}},
    {"torques of a law", "configs/torque-lqr", {"time.end=3"}},
    {"motors at the limit of their voltage",
     ball +
         "[0.08, -0.05]}\n"
         "plate: {inertia: [0.004, 0.004, 0.008]}\n"
         "gimbal: {motor: {position_loop: {kp: 5.66, kd: 0.243, ki: 58}, torque_limit: 0.17, dc: "
         "{resistance: 2, torque_constant: 0.02, gear: 8, voltage_limit: 2.2}},\n"
         "  start: {phi: -0.13, theta: 0.13, theta_rate: -1.26}}\n"
         "controller: {pd: {kv: [[0.6, 0], [0, -0.6]], kp: [[0.7, 0], [0, -0.7]]}, drives: angle, "
         "reference: {point: [0, 0]}}\n"
         "time: {end: 3, step: 0.02}\n"},
    {"push rods", "configs/pushrod", {"time.end=1.5"}},
    {"push rods without samples",
     "configs/hold",
     {"gimbal.linkage={horn: 0.025, arm: 0.08, offset: [0.06, 0.09]}", "controller.assumes=exact"}},
    {"push rods, losses, backlash and stops",
     "configs/hold",
     {"gimbal.linkage={horn: 0.025, arm: 0.08, offset: [0.06, 0.09]}", "controller.assumes=ratio",
      "gimbal.servo.backlash=0.02", "gimbal.servo.angle_limit=0.1",
      "ball.losses={rolling: 0.002, viscous: 1e-6, pivoting: 1e-5}",
      "plate.inertia=[1e-3, 2e-3, 3e-3]"}},
    {"three servos", "configs/three-servos", {"time.end=1.5"}},
    {"steppers", "configs/steppers", {"time.end=1.5"}},
    {"a hobby rig", "configs/rig", {"time.end=1.5"}},
    {"a rig that is not level", "configs/step", {"time.end=1.5"}},
    {"a rig that catches", "configs/catch", {"time.end=1.5"}},
    {"a rig that fails", "configs/falls"},
    // Once each was a switch that an integrator missed.
    {"a command that passes from one limit to the other within a step",
     ball +
         "[-0.0020711, -0.0343051], inertia_factor: 0.4}\n"
         "plate: {size: [0.3, 0.22]}\n"
         "gimbal: {mounting: {height: 0.02, phi_offset: 0.01, skew: 0.02, yaw: 0.1, base_tilt: "
         "0.01}}\n"
         "controller: {lqr: {position: 100, velocity: 1, command: 0.1}, drives: acceleration, "
         "reference: {circle: {radius: 0.05, rate: 1}}, limit: 0.02}\n"
         "events: {slip: {friction: 0.05}, lift_off: stop, tilt: {limit: 0.5, action: stop}, edge: "
         "note}\n"
         "time: {end: 3, step: 0.02}\n",
     {},
     1},
    {"a stop that kicks the command to its limit",
     ball +
         "[0.0326278, 0.0503857], velocity: [0.1, -0.1], inertia_factor: 0.6667}\n"
         "gimbal: {servo: {natural_frequency: 10, damping: 0.3, angle_limit: 0.1, rate_limit: 3, "
         "acceleration_limit: 5}}\n"
         "controller: {lqr: {position: 100, velocity: 1, command: 0.1}, drives: angle, reference: "
         "{point: [0.04, -0.03]}, limit: 0.1}\n"
         "events: {slip: {friction: 0.05}, lift_off: stop, tilt: {limit: 0.5, action: stop}}\n"
         "time: {end: 8, step: 0.02}\n",
     {},
     0,
     2e-5},
    {"backlash taken up and let go within a step",
     ball + "[-0.062182, -0.0455691], velocity: [0.1, -0.1], inertia_factor: 0.6667}\n"
            "gimbal: {servo: {natural_frequency: 30, damping: 0.3, rate_limit: 0.05, "
            "acceleration_limit: 1, backlash: 0.001}, start: {phi: -0.1, phi_rate: -0.05}}\n"
            "controller: {lqr: {position: 10, velocity: 0, command: 1}, drives: angle, reference: "
            "{point: [0, 0]}, limit: 0.02}\n"
            "events: {slip: {friction: 0.05}, lift_off: stop, tilt: {limit: 0.5, action: stop}}\n"
            "time: {end: 8, step: 0.02}\n",
     {},
     0,
     1e-7},
    {
        "a stop of the integrator next to a switch",
        ball +
            "[0.00508171, -0.0657872], velocity: [0, -0.1], inertia_factor: 0.6667}\n"
            "plate: {size: [0.3, 0.22]}\n"
            "gimbal: {servo: {time_constant: 0.01, rate_limit: 0.05, backlash: 0.03}, mounting: "
            "{height: 0.02, phi_offset: 0.01, skew: 0.02, yaw: 0.1, base_tilt: 0.01}}\n"
            "controller: {gravity_compensation: {kp: 4, kv: 4}, drives: angle, reference: {circle: "
            "{radius: 0.05, rate: 3}}, sampling: {period: 0.003, resolution: 0.002, "
            "derivative_filter: 0.03}}\n"
            "events: {slip: {friction: 0.05}, lift_off: stop, tilt: {limit: 0.5, action: stop}, "
            "edge: "
            "stop}\n"
            "time: {end: 3, step: 0.02}\n",
    },
    {
        "a law without a limit, whose servo reaches its acceleration limit",
        ball +
            "[0.05, -0.02], velocity: [0.1, -0.1]}\n"
            "gimbal: {servo: {natural_frequency: 10, damping: 0.3, acceleration_limit: 5}}\n"
            "controller: {lqr: {position: 10, velocity: 1, command: 1}, drives: angle, reference: "
            "{point: [0, 0]}}\n"
            "time: {end: 1, step: 0.02}\n",
    },
};

inline bbsim::Scenario scene_called(const std::string& what) {
  for (const SceneCase& one : scene_cases) {
    if (one.what == what) return load(one);
  }
  throw std::runtime_error("no scene " + what);
}

}  // namespace bbsim_test
