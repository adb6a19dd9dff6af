// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Rigs with many switches: every integrator finds the same ones.
#include <cmath>
#include <string>

#include "catch.hpp"
#include "solve/check_run.hpp"
#include "support/largest.hpp"
#include "support/run_in_memory.hpp"

namespace bbsim_test::test_switches {

using namespace bbsim;

namespace {

struct Case {
  const char* what;
  const char* text;
};

const Case cases[] = {
    {"a command that passes from one limit to the other within a step",
     R"(gravity: 9.81
ball: {radius: 0.02, mass: 0.03, position: [-0.0020711, -0.0343051], velocity: [0,0], inertia_factor: 0.4}
plate: {size: [0.3,0.22]}
gimbal: {mounting: {height: 0.02, phi_offset: 0.01, skew: 0.02, yaw: 0.1, base_tilt: 0.01}}
controller: {lqr: {position: 100, velocity: 1, command: 0.1}, drives: acceleration, reference: {circle: {radius: 0.05, rate: 1}}, limit: 0.02}
events: {slip: {friction: 0.05}, lift_off: stop, tilt: {limit: 0.5, action: stop}, edge: note}
time: {end: 3, step: 0.02}
output: {columns: [t,x,y,vx,vy,phi,theta,phi_rate,theta_rate,phi_acceleration,phi_command,theta_command,normal_force]}
)"},
    {"a stop that kicks the command to its limit",
     R"(gravity: 9.81
ball: {radius: 0.02, mass: 0.03, position: [0.0326278, 0.0503857], velocity: [0.1,-0.1], inertia_factor: 0.6667}
gimbal: {servo: {natural_frequency: 10, damping: 0.3, angle_limit: 0.1, rate_limit: 3, acceleration_limit: 5}}
controller: {lqr: {position: 100, velocity: 1, command: 0.1}, drives: angle, reference: {point: [0.04,-0.03]}, limit: 0.1}
events: {slip: {friction: 0.05}, lift_off: stop, tilt: {limit: 0.5, action: stop}}
time: {end: 8, step: 0.02}
output: {columns: [t,x,y,vx,vy,phi,theta,phi_rate,theta_rate,phi_acceleration,phi_command,theta_command,normal_force]}
)"},
    {"backlash taken up and let go within a step",
     R"(gravity: 9.81
ball: {radius: 0.02, mass: 0.03, position: [-0.062182, -0.0455691], velocity: [0.1,-0.1], inertia_factor: 0.6667}
gimbal: {servo: {natural_frequency: 30, damping: 0.3, rate_limit: 0.05, acceleration_limit: 1, backlash: 0.001}, start: {phi: -0.1, phi_rate: -0.05}}
controller: {lqr: {position: 10, velocity: 0, command: 1}, drives: angle, reference: {point: [0,0]}, limit: 0.02}
events: {slip: {friction: 0.05}, lift_off: stop, tilt: {limit: 0.5, action: stop}}
time: {end: 8, step: 0.02}
output: {columns: [t,x,y,vx,vy,phi,theta,phi_rate,theta_rate,phi_acceleration,phi_command,theta_command,normal_force]}
)"},
    {"a stop of the integrator next to a switch",
     R"(gravity: 9.81
ball: {radius: 0.02, mass: 0.03, position: [0.00508171, -0.0657872], velocity: [0,-0.1], inertia_factor: 0.6667}
plate: {size: [0.3,0.22]}
gimbal: {servo: {time_constant: 0.01, rate_limit: 0.05, backlash: 0.03}, mounting: {height: 0.02, phi_offset: 0.01, skew: 0.02, yaw: 0.1, base_tilt: 0.01}}
controller: {gravity_compensation: {kp: 4, kv: 4}, drives: angle, reference: {circle: {radius: 0.05, rate: 3}}, sampling: {period: 0.003, resolution: 0.002, derivative_filter: 0.03}}
events: {slip: {friction: 0.05}, lift_off: stop, tilt: {limit: 0.5, action: stop}, edge: stop}
time: {end: 3, step: 0.02}
output: {columns: [t,x,y,vx,vy,phi,theta,phi_rate,theta_rate,phi_acceleration,phi_command,theta_command,normal_force]}
)"},
    {"a continuous law without a limit, whose servo reaches its acceleration limit",
     R"(gravity: 9.81
ball: {radius: 0.02, mass: 0.03, position: [0.05, -0.02], velocity: [0.1,-0.1]}
gimbal: {servo: {natural_frequency: 10, damping: 0.3, acceleration_limit: 5}}
controller: {lqr: {position: 10, velocity: 1, command: 1}, drives: angle, reference: {point: [0,0]}}
time: {end: 1, step: 0.02}
output: {columns: [t,x,y,vx,vy,phi,theta,phi_rate,theta_rate,phi_acceleration,phi_command,theta_command,normal_force]}
)"},
};

}  // namespace

TEST_CASE("integrators agree on when a rig switches") {
  const Case& one = cases[GENERATE(0, 1, 2, 3, 4)];
  CAPTURE(one.what);
  Scenario scene = parse_scenario(one.text, "rig.yaml");
  const solve::Tolerances tolerances{1e-10, 1e-12};
  const Run radau = run_in_memory(scene, Method::radau, tolerances);
  CHECK(radau.outcome.ending != solve::Ending::failed);
  const double limit = scene.controller->limit.value_or(INFINITY);
  for (const Method method : {Method::bdf, Method::adams}) {
    CAPTURE(int(method));
    const Run other = run_in_memory(scene, method, tolerances);
    CHECK(other.outcome.ending == radau.outcome.ending);
    REQUIRE(other.samples.size() == radau.samples.size());
    double apart = 0;
    for (std::size_t i = 0; i < radau.samples.size(); ++i) {
      const model::Sample &a = radau.samples[i], &b = other.samples[i];
      apart = largest_finite(apart, {std::abs(a.ball.x - b.ball.x), std::abs(a.ball.y - b.ball.y),
                                     scene.ball.radius * std::abs(a.gamma - b.gamma)});
      for (const double command : {a.command[0], a.command[1]}) {
        CHECK(std::abs(command) <= limit * (1 + 1e-9));
      }
    }
    // Multistep methods take thousands of steps, each with 1e-10, through unstable loops that
    // amplify it a few hundred times. A missed switch would leave a centimeter.
    CHECK(apart < 2e-5);
  }
}

TEST_CASE("a servo that moves only between two nodes of a piece moves the ball") {
  const double frequency = GENERATE(300.0, 1000.0, 2000.0, 1e4);
  const double damping = GENERATE(0.5, 0.7, 1.0, 2.0);
  const std::string limit = GENERATE("rate_limit: 1", "acceleration_limit: 10");
  CAPTURE(frequency, damping, limit);
  const Scenario scene = parse_scenario(
      "ball: {radius: 0.02}\n"
      "gimbal: {servo: {natural_frequency: " +
          std::to_string(frequency) + ", damping: " + std::to_string(damping) + ", " + limit +
          "}}\n"
          "controller: {pd: {kv: 0, kp: [[1, 0], [0, -1]]}, drives: angle,\n"
          "  reference: {point: [0.1, 0]}, sampling: {period: 1}}\n"
          "time: {end: 0.5, step: 0.05}\n"
          "output: {columns: [t, x, y, vx]}\n",
      "fast.yaml");
  // When it leaves its rate limit it gives the ball 2 cm/s, within milliseconds.
  const Run pieces = run_in_memory(scene, Method::radau, {1e-8, 1e-10});
  const Run general = run_in_memory(scene, Method::bdf, {1e-10, 1e-12});
  REQUIRE(pieces.samples.size() == general.samples.size());
  double apart = 0;
  for (std::size_t i = 0; i < pieces.samples.size(); ++i) {
    const model::BallMotion &a = pieces.samples[i].ball, &b = general.samples[i].ball;
    apart = largest_finite(apart, {std::abs(a.x - b.x), std::abs(a.y - b.y)});
  }
  CHECK(apart < 1e-7);
}

TEST_CASE("backlash: a servo at rest that reverses leaves the plane where it is") {
  // At 0.2 s its command reverses; the plane waits until the gap is crossed, 2 ms later.
  const double end = GENERATE(0.2, 0.21);
  const Scenario scene = parse_scenario(
      R"(ball: {radius: 0.01, position: [-0.00912498342463637, -0.0004788716859636874],
       velocity: [-0.03344965261030668, -0.012901321040634423]}
gimbal: {servo: {natural_frequency: 500, damping: 1, backlash: 0.001}}
controller: {pd: {kv: [[0.6, 0], [0, -0.6]], kp: [[0.7, 0], [0, -0.7]]}, drives: angle,
  reference: {point: [0, 0]}, sampling: {period: 0.1}, limit: 0.2}
events: {lift_off: stop}
output: {columns: [t, x, y]}
time: {step: 0.1, end: )" +
          std::to_string(end) + "}\n",
      "turns.yaml");
  const Run run = run_in_memory(scene, Method::radau, {1e-8, 1e-10});
  CHECK(run.outcome.ending == solve::Ending::done);
  CHECK(run.outcome.occurrences.empty());
  REQUIRE(run.samples.size() > 2);
  CHECK(run.samples[2].gimbal.phi_ddot == 0);
}

TEST_CASE("backlash: a servo that starts with a rate moves neither plane nor ball") {
  Scenario scene = parse_scenario(cases[2].text, "rig.yaml");
  scene.ball.velocity = {0, 0};
  scene.controller->law = Law::pd;
  scene.controller->kp = scene.controller->kv = {};
  scene.gimbal.servo->backlash = 0.02;
  scene.gimbal.start.phi_rate = 0.05;
  const Run run = run_in_memory(scene, Method::automatic, {1e-9, 1e-11});
  CHECK(run.samples.front().ball.x_dot == 0);
  CHECK(run.samples.front().gimbal.phi == -0.1);
  CHECK(run.samples.front().gimbal.phi_dot == 0);
}

TEST_CASE("a run that ends at a switch is the start of a longer run") {
  // Samples, commands and rows coincide, the last of them at the end.
  Scenario whole = parse_scenario(
      "ball: {radius: 0.02, position: [0.05, 0.01]}\n"
      "gimbal: {servo: {natural_frequency: 30, damping: 0.8}}\n"
      "controller: {gravity_compensation: {kp: 6, kv: 6}, drives: angle, reference: {point: [0, "
      "0]},"
      " sampling: {period: 0.02, delay: 0.01}, sensor: {noise: 1e-4}}\n"
      "time: {end: 1.2, step: 0.02}\n",
      "rig.yaml");
  Scenario part = whole;
  part.time.end = 0.6;
  const Run longer = run_in_memory(whole, Method::automatic, {1e-9, 1e-11});
  const Run shorter = run_in_memory(part, Method::automatic, {1e-9, 1e-11});
  REQUIRE(shorter.samples.size() == 31);
  for (std::size_t i = 0; i < shorter.samples.size(); ++i) {
    const model::Sample &a = shorter.samples[i], &b = longer.samples[i];
    CHECK(a.ball.x == b.ball.x);
    CHECK(a.command == b.command);
    CHECK(a.measured == b.measured);
    CHECK(a.gamma == b.gamma);
  }
}

TEST_CASE("a check run has other stages and more steps between samples, on any rig") {
  Scenario scene = parse_scenario(cases[3].text, "rig.yaml");
  const bool smooth = GENERATE(true, false);
  if (smooth) {
    scene = parse_scenario(cases[0].text, "rig.yaml");
    scene.controller->limit.reset();
  }
  scene.events = {};
  const model::Model rig = model::assemble(scene, false);
  CHECK(rig.hybrid() == !smooth);
  const solve::OutputGrid grid(scene.time);
  std::vector<std::vector<double>> ends;
  std::size_t steps = 0;
  for (const solve::CheckRun how : {solve::CheckRun{8, 1}, {8, 3}, {12, 1}, {12, 3}}) {
    solve::Trajectory rows(rig.row_size());
    const auto outcome = solve::integrate_check_run(rig, how, {1e-7, 1e-9}, grid, rows, {});
    REQUIRE(outcome.ending == solve::Ending::done);
    const double* const last = rows.row(rows.rows() - 1);
    ends.emplace_back(last, last + rig.size());
    // A piece of such a rig takes one step or few.
    if (how.parts == 3 && !smooth) CHECK(outcome.statistics.steps > 2 * steps);
    steps = outcome.statistics.steps;
  }
  for (std::size_t i = 0; i < ends.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      CHECK(ends[i] != ends[j]);
      // Within the tolerance, which the loop amplifies a few hundred times over thousands of
      // pieces.
      CHECK(std::abs(ends[i][0] - ends[j][0]) < 1e-4);
    }
  }
}

}  // namespace bbsim_test::test_switches
