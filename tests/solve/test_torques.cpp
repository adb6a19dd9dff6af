// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Gimbals driven by torques: docs/explanation/losses-and-torques.md.
#include <cmath>
#include <string>

#include "catch.hpp"
#include "model/spectrum.hpp"
#include "support/energy_balance.hpp"
#include "support/largest.hpp"
#include "support/reading.hpp"
#include "support/run_in_memory.hpp"

namespace bbsim_test::test_torques {

using namespace bbsim;

namespace {

constexpr solve::Tolerances tight{1e-11, 1e-13};

// A plate with a negligible ball: J = 5e-3 kg m^2 about both axes while it is level.
std::string bare(const std::string& gimbal) {
  return "gravity: 9.81\n"
         "ball: {radius: 0.02, mass: 1e-12}\n"
         "plate: {inertia: [4e-3, 3e-3, 5e-3]}\n"
         "gimbal: {ring_inertia: 1e-3, " +
         gimbal +
         "}\n"
         "time: {end: 1, step: 0.05}\n";
}

}  // namespace

TEST_CASE("a motor's dry friction holds its axis until the torque exceeds it") {
  const Method method = GENERATE(Method::radau, Method::bdf, Method::adams);
  Scenario scene =
      test::parse(bare("motor: {rotor_inertia: 1e-3, friction: 0.02}, torque: {phi: {ramp: {start: "
                       "0, rate: 0.04}}}"));
  scene.events.stick = OnEvent::note;
  const Run run = run_in_memory(scene, method, tight);
  for (const model::Sample& s : run.samples) {
    const double t = std::max(0.0, s.t - 0.5);
    CAPTURE(s.t);
    CHECK(std::abs(s.gimbal.phi_dot - 0.02 * t * t / 5e-3) < 1e-10);
    CHECK(std::abs(s.gimbal.phi - 0.02 * t * t * t / 3 / 5e-3) < 1e-10);
    CHECK(s.gimbal.theta == 0);
    CHECK(s.gimbal.theta_dot == 0);
    if (s.t <= 0.5) CHECK(s.gimbal.phi == 0);
  }
  REQUIRE(run.outcome.occurrences.size() == 2);
  CHECK(run.outcome.occurrences[0].name == "stick_phi");
  CHECK(run.outcome.occurrences[1].name == "stick_theta");
}

TEST_CASE("a gimbal with both axes stuck holds plate and ball bit for bit, in one step") {
  Scenario scene =
      test::parse(bare("motor: {friction: 0.05}, torque: {phi: 0.02, theta: -0.03}, start: {phi: "
                       "0.001, theta: 0.002}"));
  scene.ball.mass = 0.05;
  scene.ball.position = {0.01, 0.02};
  scene.ball.losses.rolling = 0.005;
  scene.time = {1e5, 1e3};
  const Run run = run_in_memory(scene, Method::automatic, {1e-8, 1e-10});
  CHECK(run.outcome.statistics.steps == 1);
  const model::Sample& last = run.samples.back();
  CHECK(last.gimbal.phi == 0.001);
  CHECK(last.gimbal.theta == 0.002);
  CHECK(last.ball.x == 0.01);
  CHECK(last.ball.y == 0.02);
}

TEST_CASE("friction of its motors brings a swinging plate to rest") {
  Scenario scene = test::parse(
      "gravity: 9.81\n"
      "ball: {radius: 0.02, mass: 1e-9, losses: {rolling: 0.5}}\n"
      "plate: {inertia: [4e-3, 3e-3, 5e-3], mass: 1, centre_of_mass: -0.04}\n"
      "gimbal: {ring_inertia: 1e-3, motor: {friction: 0.003}, start: {phi: 0.1, theta: 0.05}, "
      "torque: {}}\n"
      "events: {stick: note}\n"
      "time: {end: 20, step: 0.1}\n");
  const Method method = GENERATE(Method::radau, Method::bdf);
  const Run run = run_in_memory(scene, method, {1e-10, 1e-12});
  const model::Sample& last = run.samples.back();
  CHECK(last.gimbal.phi_dot == 0);
  CHECK(last.gimbal.theta_dot == 0);
  CHECK(last.ball.x == 0);
  // Friction holds the weight only within this angle.
  CHECK(std::abs(last.gimbal.phi) <= 0.003 / (9.81 * 0.04) * 1.01);
  CHECK(energy_gap(scene, run) < 1e-9);
}

TEST_CASE("a DC motor at its highest voltage reaches its idle speed") {
  const Scenario scene = test::parse(
      bare("motor: {dc: {resistance: 2, torque_constant: 0.05, gear: 4, voltage_limit: 6}}, "
           "torque: {theta: 1}"));
  // Later the plate turns so fast that even this ball is thrown off.
  const Run run = run_in_memory(
      [&] {
        Scenario first = scene;
        first.time.end = 0.4;
        return first;
      }(),
      Method::radau, tight);
  // The demand exceeds what 6 V give: gear k_t V / R = 0.6 N m at rest.
  const double by_current = 0.2, rate = by_current * by_current / (2 * 4e-3), idle = 6 / by_current;
  const model::BallConstants constants = model::constants_of(scene);
  for (const model::Sample& s : run.samples) {
    CAPTURE(s.t);
    CHECK(std::abs(s.gimbal.theta_dot - idle * (1 - std::exp(-rate * s.t))) < 1e-8);
    const model::Dynamics now = model::dynamics(s, constants);
    CHECK(std::abs(now.voltage[1] - 6) < 1e-9);
    CHECK(std::abs(now.current[1] - (6 - by_current * s.gimbal.theta_dot) / 2) < 1e-8);
    CHECK(s.coupled->asked[1] == 1);
  }
}

TEST_CASE("a torque limit applies in both directions") {
  const Scenario scene = test::parse(bare(
      "motor: {torque_limit: 0.03}, torque: {theta: {sinusoid: {amplitude: 0.05, frequency: 9}}}"));
  const Run run = run_in_memory(scene, Method::radau, tight);
  std::size_t limited = 0;
  for (const model::Sample& s : run.samples) {
    const double asked = 0.05 * std::sin(9 * s.t);
    CHECK(std::abs(s.coupled->asked[1] - asked) < 1e-15);
    CHECK(std::abs(s.coupled->given[1] - std::clamp(asked, -0.03, 0.03)) < 1e-15);
    limited += std::abs(asked) > 0.03 ? 1 : 0;
  }
  CHECK(limited > 5);
  CHECK(energy_gap(scene, run) < 1e-9);
}

TEST_CASE("a stiff position loop is a second-order servo") {
  // kp = J w^2, kd = 2 zeta w J. The remaining difference is the ball's weight over kp: with ten
  // times the stiffness, a tenth.
  double before = 0;
  for (const double stiffness : {1e2, 1e3, 1e4}) {
    const double w = std::sqrt(stiffness / 5e-3), kd = 2 * 0.7 * w * 5e-3;
    const std::string rest =
        "}\ncontroller: {pd: {kv: [[0.06, 0], [0, -0.06]], kp: [[0.07, 0], [0, -0.07]]}, drives: "
        "angle, "
        "reference: {circle: {radius: 0.05, rate: -0.3}}}\ntime: {end: 3, step: 0.1}\n"
        "gravity: 9.81\nball: {radius: 0.01, mass: 0.1, position: [0.05, 0]}\n"
        "plate: {inertia: [4e-3, 3e-3, 5e-3]}\n";
    const Scenario motors = test::parse(
        "gimbal: {ring_inertia: 1e-3, motor: {rotor_inertia: 1e-3, position_loop: {kp: " +
        std::to_string(stiffness) + ", kd: " + std::to_string(kd) + "}}" + rest);
    const Scenario servo = test::parse("gimbal: {servo: {natural_frequency: " + std::to_string(w) +
                                       ", damping: 0.7}" + rest);
    const Run a = run_in_memory(motors, Method::radau, {1e-10, 1e-12});
    const Run b = run_in_memory(servo, Method::radau, {1e-10, 1e-12});
    double apart = 0;
    for (std::size_t i = 0; i < a.samples.size(); ++i) {
      apart = largest_finite(apart, {std::abs(a.samples[i].ball.x - b.samples[i].ball.x)});
    }
    CAPTURE(stiffness, apart);
    if (before > 0) {
      CHECK(before / apart > 8);
      CHECK(before / apart < 12);
    }
    before = apart;
  }
}

TEST_CASE("laws over torques and voltages stabilize the plate and the ball") {
  const std::string law = GENERATE(
      std::string(
          "lqr: {position: 200, velocity: 1, angle: 1, rate: 0.1, command: 20}, drives: torque"),
      std::string("lqr: {position: 200, angle: 10, rate: 0.1, command: 0.1}, drives: voltage"),
      std::string(
          "lqr: {position: 200, velocity: 1, angle: 1, rate: 0.1, command: 20}, drives: torque, "
          "sampling: {period: 0.01}"),
      std::string("lqr: {position: 2, velocity: 1, command: 10}, drives: angle"),
      std::string("pid: {kv: [[0.9, 0], [0, -0.9]], kp: [[1.2, 0], [0, -1.2]], ki: [[0.6, 0], [0, "
                  "-0.6]]}, drives: angle"));
  CAPTURE(law);
  const bool by_angle = law.ends_with("angle");
  const Scenario scene = test::parse(
      "gravity: 9.81\n"
      "ball: {radius: 0.02, mass: 0.05, position: [0.05, -0.03]}\n"
      "plate: {inertia: [4e-3, 3e-3, 5e-3], mass: 0.4, centre_of_mass: 0.01}\n"
      "gimbal: {ring_inertia: 1e-3, motor: {rotor_inertia: 1e-3, viscous: 0.01, dc: {resistance: "
      "2, "
      "torque_constant: 0.05, gear: 4}" +
      std::string(by_angle ? ", position_loop: {kp: 4, kd: 0.2}" : "") + "}}\ncontroller: {" + law +
      ", reference: {point: [0, 0]}}\ntime: {end: 8, step: 0.1}\n");
  const model::Model model = model::assemble(scene, false);
  if (scene.controller->sampling) {
    CHECK(std::abs(model::sampled_poles(model).front()) < 1);
  } else {
    const model::Eigenvalues poles = model::closed_loop_poles(model);
    CHECK(poles.size() == (scene.controller->law == Law::pid ? 10 : 8));
    CHECK(model::stable(poles));
  }
  const Run run = run_in_memory(scene, Method::radau, {1e-10, 1e-12});
  CHECK(std::abs(run.samples.back().ball.x) < 1e-3);
  CHECK(std::abs(run.samples.back().ball.y) < 1e-3);
  CHECK(energy_gap(scene, run) < 1e-9);
}

TEST_CASE("a position loop's integral removes the deflection by the ball's weight") {
  const auto scene = [](const char* ki) {
    return test::parse(
        std::string(
            "gravity: 9.81\n"
            "ball: {radius: 0.02, mass: 0.3, position: [0.1, 0], losses: {rolling: 0.2}}\n"
            "plate: {inertia: [4e-3, 3e-3, 5e-3]}\n"
            "gimbal: {ring_inertia: 1e-3, motor: {viscous: 0.05, position_loop: {kp: 10, kd: 0.5") +
        ki +
        "}}}\n"
        "controller: {pd: {kv: 0, kp: 0}, drives: angle, reference: {point: [0, 0]}}\n"
        "time: {end: 10, step: 0.1}\n");
  };
  // m g x / (kp - m g (r + h) ...): the plate's deflection by the ball's weight at 0.1 m.
  const Run bent = run_in_memory(scene(""), Method::radau, {1e-10, 1e-12});
  const Run level = run_in_memory(scene(", ki: 20"), Method::radau, {1e-10, 1e-12});
  CHECK(bent.samples.back().gimbal.phi == Approx(0.3 * 9.81 * 0.1 / 10).epsilon(0.02));
  CHECK(std::abs(level.samples.back().gimbal.phi) < 1e-4);
  CHECK(bent.samples.back().ball.x == Approx(0.1).epsilon(0.02));
}

}  // namespace bbsim_test::test_torques
