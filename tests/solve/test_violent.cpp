// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Stiff, unstable and diverging scenes, extreme sizes, and a pulse.
#include <cmath>

#include "solve/hard_cases.hpp"

namespace bbsim_test::test_violent {

using namespace bbsim;

namespace {

constexpr solve::Tolerances usual{1e-9, 1e-11};

}  // namespace

TEST_CASE("servos of 2000 and 20000 rad/s: accuracy of the slow loop, in few steps") {
  const char* const frequency = GENERATE("2000", "20000");
  // Not Adams, whose steps stability would keep below 1/20000 s.
  const Method method = GENERATE(Method::automatic, Method::radau, Method::bdf);
  CAPTURE(frequency, name_of(method));
  const Scenario scene =
      hard_case("stiff-servo", {std::string("gimbal.servo.natural_frequency=") + frequency});
  static const ExactRun references[2] = {
      quad_reference(hard_case("stiff-servo", {"gimbal.servo.natural_frequency=2000"})),
      quad_reference(hard_case("stiff-servo", {"gimbal.servo.natural_frequency=20000"}))};
  const Run run = run_in_memory(scene, method, usual);
  check_against(references[std::string(frequency) == "20000"], run, usual, scene.ball.radius);
  // One step per 1/omega_n would be 42000 or 420000.
  CHECK(run.outcome.statistics.steps < 4000);
}

TEST_CASE("a solution that diverges ends at its singularity, with its rows and a reason") {
  const Method method = GENERATE(Method::automatic, Method::radau, Method::bdf, Method::adams);
  CAPTURE(name_of(method));
  const Scenario scene = hard_case("blow-up");
  const Run run = run_in_memory(scene, method, usual);
  CHECK(run.outcome.ending == solve::Ending::failed);
  CHECK_FALSE(run.outcome.reason.empty());
  // The solution near T is about 1/(T - t)^p, so the end is as sharp as the last step is short.
  CHECK(std::abs(run.outcome.reached - 0.7488) < 1e-3);
  CHECK(run.samples.size() == 75);
  CHECK(run.outcome.statistics.steps < 20000);
  // Up to t = 0.6 s it is an ordinary growing scene.
  Scenario before = scene;
  before.time.end = 0.6;
  const ExactRun reference = quad_reference(before);
  for (std::size_t i = 1; i < reference.x.size() - 1; ++i) {
    // The ball is not the only part that grows: its errors pass through the gimbal, whose gain of
    // kv = 100 multiplies them.
    const double allowed = 100 * allowance(run, usual, scene.ball.radius, i);
    CHECK(std::abs(run.samples[i].ball.x - reference.x[i]) < allowed);
    CHECK(std::abs(run.samples[i].ball.y - reference.y[i]) < allowed);
  }
}

TEST_CASE("tolerances below the rounding errors of a run are not taken for divergence") {
  // Steps shrink there while rounding is taken for an error, and grow again.
  const Scenario scene = read_scenario(
      BBSIM_SOURCE_DIR "/tests/data/scenarios/stiff-servo.yaml",
      {"controller.pd.kv.0.0=0.06189348835829111", "controller.pd.kp.1.1=-0.05043124306458094"});
  const solve::Tolerances tight =
      GENERATE(solve::Tolerances{1e-13, 1e-15}, solve::Tolerances{1e-14, 1e-16});
  const Run run = run_in_memory(scene, Method::radau, tight);
  CHECK(run.outcome.reason == "");
  CHECK(run.outcome.reached == scene.time.end);
}

TEST_CASE("exponential instability keeps its relative error, over 15 decades") {
  const Method method = GENERATE(Method::automatic, Method::radau, Method::bdf, Method::adams);
  CAPTURE(name_of(method));
  const Scenario scene = hard_case("unstable");
  const Run run = run_in_memory(scene, method, usual);
  REQUIRE(run.outcome.ending == solve::Ending::done);
  REQUIRE(run.samples.size() == 201);
  const double w = 2, g = scene.gravity, r = scene.ball.radius;
  const double k = w * std::sqrt(5.0 / 7), q = w * std::sqrt(2.0 / 7);
  const double b = 5 * g / (12 * w * k), c = r * 5 * w * (2.0 / 7) / q;
  for (std::size_t i = 1; i < run.samples.size(); ++i) {
    const double t = run.samples[i].t;
    const double x =
        0.05 * std::cosh(k * t) + b * std::sinh(k * t) - 5 * g / (12 * w * w) * std::sin(w * t);
    const double vy = 0.1 * std::cos(q * t) + c * std::sin(q * t);
    // Rounding of the closed form, with k t up to 34, and of the solver's constants.
    const double rounding = 40 * 4 * 2.3e-16 * std::abs(x);
    CHECK(std::abs(run.samples[i].ball.x - x) < allowance(run, usual, r, i) + rounding);
    // The cross direction does not grow, but BDF measures its local error over all states.
    if (method == Method::bdf || method == Method::adams) continue;
    const double steps = static_cast<double>(run.outcome.statistics.steps);
    CHECK(std::abs(run.samples[i].ball.y_dot - vy) < steps * (usual.rtol + usual.atol));
  }
}

TEST_CASE("theta passes 90 degrees and phi turns over and over") {
  const Method method = GENERATE(Method::automatic, Method::radau, Method::bdf, Method::adams);
  CAPTURE(name_of(method));
  const Scenario scene = hard_case("overhead");
  static const ExactRun reference = quad_reference(hard_case("overhead"));
  const Run run = run_in_memory(scene, method, usual);
  check_against(reference, run, usual, scene.ball.radius);
  double largest_theta = 0;
  for (const auto& sample : run.samples) {
    largest_theta = std::max(largest_theta, std::abs(sample.gimbal.theta));
  }
  CHECK(largest_theta > 1.9);
  CHECK(run.samples.back().gimbal.phi == 25);
}

TEST_CASE("balls of 10 micrometers and of 10 meters") {
  using Overrides = std::vector<std::string>;
  const Overrides overrides =
      GENERATE(Overrides{}, Overrides{"ball.radius=10", "ball.position=[0, -1]"});
  const Method method = GENERATE(Method::automatic, Method::radau, Method::bdf, Method::adams);
  CAPTURE(overrides, name_of(method));
  const Scenario scene = read_scenario(data_file("scenarios/small-ball.yaml"), overrides);
  const Run run = run_in_memory(scene, method, usual);
  check_against(quad_reference(scene), run, usual, scene.ball.radius);
  CHECK(run.outcome.statistics.steps < 5000);
}

TEST_CASE("a pulse of 1 ms in 1000 s has its effect") {
  const Method method = GENERATE(Method::automatic, Method::radau, Method::bdf, Method::adams);
  CAPTURE(name_of(method));
  const Scenario scene = hard_case("pulse");
  const solve::Tolerances tolerances{scene.solver.rtol, scene.solver.atol};
  const Run run = run_in_memory(scene, method, tolerances);
  static const ExactRun reference = quad_reference(hard_case("pulse"));
  check_against(reference, run, tolerances, scene.ball.radius);
  // Nothing before it: the table's zeros are exact, and the spline's ringing is below 3.7^-60.
  CHECK(std::abs(run.samples[499].ball.x - 0.05) < 1e-15);
  // After it, 7 x'' = 5 g sin phi - 7 r phi'' + 5 x phi'^2: the first term gives 5/7 g times the
  // area 0.02 * 0.5 ms * 256/315, the second nothing, and the third 5/7 x times 0.02^2 / 0.5 ms *
  // 64 B, where B is the integral of s^2 (1 - s^2)^6 over [-1, 1], 2048/45045. Accurate to a
  // percent: x moves by r phi = 0.2 mm of 50 mm on the way.
  const double speed =
      5.0 / 7 *
      (scene.gravity * 0.02 * 0.5e-3 * 256 / 315 * 1 + 0.05 * 4e-4 / 0.5e-3 * 64 * 2048 / 45045);
  CHECK(std::abs(run.samples.back().ball.x_dot / speed - 1) < 0.01);
}

}  // namespace bbsim_test::test_violent
