// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Hard scenes: stiff, unstable, diverging, very long, very short and nearly still ones, with every
// integrator.
#include <cmath>
#include <cstdlib>

#include "base/error.hpp"
#include "solve/hard_cases.hpp"

namespace bbsim_test::test_hard_scenes {

using namespace bbsim;

namespace {

constexpr solve::Tolerances usual{1e-9, 1e-11};

const auto every_method = [] {
  return GENERATE(Method::automatic, Method::radau, Method::bdf, Method::adams);
};

}  // namespace

TEST_CASE("hard scenes are within the allowance of their tolerances, in few steps") {
  struct Case {
    const char* name;
    std::vector<std::string> changes;
    std::size_t most_steps;
    bool stiff = false;  // stability would keep the steps of Adams below 1/20000 s
  };
  const Case cases[] = {{"hard/stiff-servo", {"gimbal.servo.natural_frequency=2000"}, 4000, true},
                        {"hard/stiff-servo", {"gimbal.servo.natural_frequency=20000"}, 4000, true},
                        {"hard/overhead", {}, 1'000'000},  // theta passes 90 degrees
                        {"hard/pulse", {"solver={rtol: 1e-9, atol: 1e-11}"}, 1'000'000},
                        {"small-ball", {}, 5000},  // 10 micrometers
                        {"small-ball", {"ball.radius=10", "ball.position=[0, -1]"}, 5000}};
  for (const Case& one : cases) {
    CAPTURE(one.name, one.changes);
    const std::string name = one.name;
    const Scenario scene =
        name.starts_with("hard/")
            ? hard_case(name.substr(5), one.changes)
            : read_scenario(data_file("scenarios/" + name + ".yaml"), one.changes);
    const ExactRun reference = quad_reference(scene);
    for (const Method method : {Method::automatic, Method::radau, Method::bdf, Method::adams}) {
      if (one.stiff && method == Method::adams) continue;
      CAPTURE(name_of(method));
      const Run run = run_in_memory(scene, method, usual);
      check_against(reference, run, usual, scene.ball.radius);
      // One step per 1/omega_n of the servo would be 42,000 or 420,000.
      const bool multistep = method == Method::bdf || method == Method::adams;
      CHECK(run.outcome.statistics.steps < (multistep ? one.most_steps : one.most_steps / 10));
    }
  }
}

TEST_CASE("a solution that diverges ends at its singularity, with its rows and a reason") {
  const Method method = every_method();
  CAPTURE(name_of(method));
  const Scenario scene = hard_case("blow-up");
  const Run run = run_in_memory(scene, method, usual);
  CHECK(run.outcome.ending == solve::Ending::failed);
  CHECK_FALSE(run.outcome.reason.empty());
  // BDF at an rtol of 1e-12 ends at 0.7487576252 s. Steps of collocation are fractions of the
  // remaining time; its run ends when they are shorter than 1e-5 of the time.
  const bool multistep = method == Method::bdf || method == Method::adams;
  CHECK(std::abs(run.outcome.reached / 0.7487576252 - 1) < (multistep ? 1e-4 : 1e-5));
  CHECK(run.samples.size() == 75);  // 0 to 0.74 s
  CHECK(run.outcome.statistics.steps < (multistep ? 20000 : 2000));
  const std::vector<double>& last = run.outcome.last_state;
  CHECK(run.outcome.worst_state < last.size());
  for (const double value : last) CHECK(std::isfinite(value));
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
  const Method method = every_method();
  CAPTURE(name_of(method));
  const Scenario scene = hard_case("unstable");
  const Run run = whole_run(scene, method, usual);
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

TEST_CASE("a pulse of 1 ms in 1000 s has its effect") {
  const Method method = every_method();
  CAPTURE(name_of(method));
  const Scenario scene = hard_case("pulse");
  const Run run = run_in_memory(scene, method, {scene.solver.rtol, scene.solver.atol});
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

TEST_CASE("a run that creeps ends with its reason, but an event on the way stops it") {
  const Method method = GENERATE(Method::automatic, Method::bdf, Method::adams);
  CAPTURE(name_of(method));
  const Run run = run_in_memory(hard_case("creep"), method, {1e-8, 1e-10});
  CHECK(run.outcome.why == solve::Why::too_slow);
  CHECK(run.outcome.reached > 1.6e-5);
  CHECK(run.outcome.reached < 1.8e-5);
  CHECK(run.outcome.last_state.size() == 9);
  CHECK(run.outcome.statistics.steps < 300'000);
  // The event is reached with steps of 1e-12 s.
  const Run stopped = run_in_memory(
      hard_case("creep", {"events.tilt={limit: 1.1e-4, action: stop}"}), method, {1e-8, 1e-10});
  REQUIRE(stopped.outcome.ending == solve::Ending::stopped);
  CHECK(stopped.outcome.occurrences.back().name == "tilt");
}

TEST_CASE("a hundred thousand periods: the error does not grow") {
  struct Case {
    Method method;
    double end;  // s, and periods
    solve::Tolerances tolerances;
  };
  // Multistep methods take some 100 steps per period: they get fewer periods, looser tolerances.
  const auto [method, end, tolerances] =
      GENERATE(Case{Method::automatic, 1e5, {1e-9, 1e-11}}, Case{Method::radau, 1e5, {1e-6, 1e-8}},
               Case{Method::bdf, 5e3, {1e-6, 1e-8}}, Case{Method::adams, 5e3, {1e-6, 1e-8}});
  CAPTURE(name_of(method), tolerances.rtol);
  Scenario scene = hard_case("many-periods");
  scene.time = {end, end / 1000};
  const Run run = whole_run(scene, method, tolerances, false);
  REQUIRE(run.samples.size() == 1001);
  // Once the transient has decayed, the ball returns to one place every period: that of the quad
  // reference after 40 periods. The slowest mode decays as e^(-2 t).
  static const ExactRun reference =
      quad_reference(hard_case("many-periods", {"time.end=40", "time.step=40"}));
  double early = 0, late = 0;
  for (std::size_t i = 10; i < run.samples.size(); ++i) {
    const model::BallMotion& ball = run.samples[i].ball;
    const double error =
        std::max(std::abs(ball.x - reference.x.back()), std::abs(ball.y - reference.y.back()));
    double& half = i <= 500 ? early : late;
    half = std::max(half, error);
  }
  // The loop damps an error within some seconds, at most a hundred steps of either method, each
  // with rtol of the rates of gimbal and ball, below 1, and atol.
  const double allowed = 100 * (tolerances.rtol + tolerances.atol);
  CAPTURE(early, late, run.outcome.statistics.steps);
  CHECK(early < allowed);
  CHECK(late < allowed);
  // Phase: t and the frequency are rounded, which moves the reference at t by 2 eps omega t.
  const double phase = 2 * 2.3e-16 * 6.3 * end * 0.02;
  CHECK(late < 3 * early + phase);
}

TEST_CASE("at rest for a million seconds, also in a loop: exact, and nearly free of cost") {
  const Method method = every_method();
  const bool looped = GENERATE(false, true);
  CAPTURE(name_of(method), looped);
  Scenario scene = looped ? scenario_named("fig2b") : hard_case("rest");
  if (looped) {
    scene.ball.position = {0.1, 0.2};
    scene.controller->reference = PointReference{{0.1, 0.2}};
  }
  const Run run = whole_run(scene, method, {1e-8, 1e-10});
  const bool multistep = method == Method::bdf || method == Method::adams;
  CHECK(run.outcome.statistics.steps <= (multistep ? 50 : 5));
  for (const model::Sample& sample : run.samples) {
    CHECK(sample.ball.x == 0.1);
    CHECK(sample.ball.y == 0.2);
    CHECK(sample.ball.x_dot == 0);
    CHECK(sample.ball.y_dot == 0);
    CHECK(sample.gamma == 0);
    CHECK(sample.gimbal.phi == 0);
  }
}

TEST_CASE("start values of 1e-300 and denormal ones have no effect") {
  const bool denormal = GENERATE(false, true);
  const Method method = every_method();
  CAPTURE(name_of(method), denormal);
  Scenario tiny = hard_case("tiny-start");
  // Scenario files refuse denormals, because they lose digits.
  CHECK_THROWS_AS(hard_case("tiny-start", {"ball.velocity.0=5e-324"}), InputError);
  if (denormal) tiny.ball.velocity = {5e-324, -1e-310};
  REQUIRE(tiny.ball.velocity[0] > 0);
  const solve::Tolerances tolerances{1e-9, 1e-11};
  const Run run = run_in_memory(tiny, method, tolerances);
  Scenario zero = tiny;
  zero.ball.position[0] = zero.ball.spin = 0;
  zero.ball.velocity = {0, 0};
  check_against(quad_reference(zero), run, tolerances, tiny.ball.radius);

  // On a level plane the ball moves freely: x = x0 + x0' t.
  Scenario level = tiny;
  level.gimbal.motion = {{0.0}, {0.0}};
  const Run still = whole_run(level, method, tolerances);
  CHECK(still.outcome.statistics.steps < 50);
  for (const model::Sample& sample : still.samples) {
    const double x = 1e-300 + tiny.ball.velocity[0] * sample.t;
    CHECK(std::abs(sample.ball.x - x) < 1e-310);  // relative: 1e-10
    CHECK(std::abs(sample.ball.y + 0.1) < 1e-15);
  }
}

TEST_CASE("the finest tolerance is met, or refused with a reason; 1 is refused") {
  const Method method = every_method();
  CAPTURE(name_of(method));
  const Scenario scene = hard_case("finest");
  const solve::Tolerances tolerances{scene.solver.rtol, scene.solver.atol};
  CHECK(tolerances.rtol == 1e-14);
  const Run run = run_in_memory(scene, method, tolerances);
  CAPTURE(run.outcome.reason, run.outcome.statistics.steps);
  if (run.outcome.ending == solve::Ending::done) {
    check_against(quad_reference(scene), run, tolerances, scene.ball.radius);
  } else {
    CHECK(run.outcome.ending == solve::Ending::failed);
    CHECK_FALSE(run.outcome.reason.empty());
    CHECK(method != Method::automatic);  // its order makes the tolerance attainable
    CHECK(method != Method::radau);
  }
  CHECK_THROWS_AS(hard_case("finest", {"solver.rtol=1"}), InputError);
}

TEST_CASE("a scene of a nanosecond") {
  const Method method = every_method();
  CAPTURE(name_of(method));
  const Scenario scene = hard_case("nanosecond");
  const Run run = whole_run(scene, method, {1e-9, 1e-11});
  REQUIRE(run.samples.size() == 11);
  CHECK(run.samples.back().t == 1e-9);
  for (const model::Sample& sample : run.samples) {
    const double t = sample.t;
    // x = x0' t + x'' t^2 / 2, whose last term is below 1e-18 m; a few rounding errors of 1e-9 m.
    CHECK(std::abs(sample.ball.x - t) < 1e-18);
    CHECK(std::abs(sample.ball.y + 0.1) < 1e-16);
    // 7 x'' = 5 g sin phi - 7 r c phi'' + ..., 7 y'' = ...: accelerations of order 0.1 m/s^2.
    CHECK(std::abs(sample.ball.x_dot - 1) < 1e-9);
  }
}

TEST_CASE("a million seconds that overflow end with a reason") {
  const Scenario scene = hard_case("overflow");
  const Run run = run_in_memory(scene, Method::automatic, {1e-6, 1e-8});
  CHECK(run.outcome.ending == solve::Ending::failed);
  CHECK_FALSE(run.outcome.reason.empty());
  CHECK(run.outcome.reached > 5e4);
  CHECK(run.outcome.reached < 5e5);
  for (const model::Sample& sample : run.samples) {
    REQUIRE(std::isfinite(sample.ball.x));
    REQUIRE(std::isfinite(sample.ball.y));
  }
}

TEST_CASE("forward and back again") {
  const Method method = every_method();
  CAPTURE(name_of(method));
  const solve::Tolerances tolerances{1e-10, 1e-12};
  const Scenario there = hard_case("there-and-back");
  const double end = there.time.end;
  const Run forwards = whole_run(there, method, tolerances);
  const model::Sample& turn = forwards.samples.back();

  Scenario back = there;
  back.ball.position = {turn.ball.x, turn.ball.y};
  back.ball.velocity = {-turn.ball.x_dot, -turn.ball.y_dot};
  back.ball.spin = -turn.ball.gamma_dot;
  for (Profile* profile : {&back.gimbal.motion->phi, &back.gimbal.motion->theta}) {
    for (ProfileTerm& term : *profile) {
      // a sin(w (end - t) + p) = -a sin(w t - (w end + p)).
      auto& wave = std::get<Sinusoid>(term);
      wave.phase = -(wave.frequency * end + wave.phase);
      wave.amplitude = -wave.amplitude;
    }
  }
  const Run backwards = whole_run(back, method, tolerances);
  const double r = there.ball.radius;
  // The error of the way forward drifts for as long again; the way back adds its own.
  const std::size_t last = forwards.samples.size() - 1;
  const double allowed = allowance(forwards, tolerances, r, last) * (1 + end) +
                         allowance(backwards, tolerances, r, last);
  for (std::size_t i = 0; i <= last; ++i) {
    const model::BallMotion& a = forwards.samples[i].ball;
    const model::BallMotion& b = backwards.samples[last - i].ball;
    CHECK(std::abs(a.x - b.x) < allowed);
    CHECK(std::abs(a.y - b.y) < allowed);
    CHECK(std::abs(a.x_dot + b.x_dot) < allowed);
    CHECK(std::abs(a.y_dot + b.y_dot) < allowed);
    CHECK(std::abs(a.gamma_dot + b.gamma_dot) * r < allowed);
  }
  CHECK(allowed < 1e-2);  // in meters: returning is no coincidence
  // gamma returns by the same amount.
  CHECK(std::abs(forwards.samples.back().gamma + backwards.samples.back().gamma) * r < allowed);
}

}  // namespace bbsim_test::test_hard_scenes
