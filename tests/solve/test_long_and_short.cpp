// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Very long, very short and nearly still scenes, extreme tolerances, and reversed time.
#include <cmath>
#include <cstdlib>

#include "base/error.hpp"
#include "solve/hard_cases.hpp"

namespace bbsim_test::test_long_and_short {

using namespace bbsim;

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
  const Run run = run_in_memory(scene, method, tolerances, false);
  REQUIRE(run.outcome.ending == solve::Ending::done);
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

TEST_CASE("at rest for a million seconds: exact, and nearly free of cost") {
  const Method method = GENERATE(Method::automatic, Method::radau, Method::bdf, Method::adams);
  CAPTURE(name_of(method));
  const Run run = run_in_memory(hard_case("rest"), method, {1e-8, 1e-10});
  REQUIRE(run.outcome.ending == solve::Ending::done);
  CHECK(run.outcome.statistics.steps < 50);
  for (const model::Sample& sample : run.samples) {
    CHECK(sample.ball.x == 0.1);
    CHECK(sample.ball.y == 0.2);
    CHECK(sample.ball.x_dot == 0);
    CHECK(sample.ball.y_dot == 0);
    CHECK(sample.gamma == 0);
  }
}

TEST_CASE("start values of 1e-300 and denormal ones have no effect") {
  const bool denormal = GENERATE(false, true);
  const Method method = GENERATE(Method::automatic, Method::radau, Method::bdf, Method::adams);
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
  const Run still = run_in_memory(level, method, tolerances);
  REQUIRE(still.outcome.ending == solve::Ending::done);
  CHECK(still.outcome.statistics.steps < 50);
  for (const model::Sample& sample : still.samples) {
    const double x = 1e-300 + tiny.ball.velocity[0] * sample.t;
    CHECK(std::abs(sample.ball.x - x) < 1e-310);  // relative: 1e-10
    CHECK(std::abs(sample.ball.y + 0.1) < 1e-15);
  }
}

TEST_CASE("the finest tolerance is met, or refused with a reason; 1 is refused") {
  const Method method = GENERATE(Method::automatic, Method::radau, Method::bdf, Method::adams);
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
  const Method method = GENERATE(Method::automatic, Method::radau, Method::bdf, Method::adams);
  CAPTURE(name_of(method));
  const Scenario scene = hard_case("nanosecond");
  const Run run = run_in_memory(scene, method, {1e-9, 1e-11});
  REQUIRE(run.outcome.ending == solve::Ending::done);
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

TEST_CASE("a million seconds under control") {
  const Method method = GENERATE(Method::automatic, Method::radau);
  // The paper's circle, 47,746 times around: its slowest mode decays in 1000 s, and the circle is
  // steady from then on.
  const Scenario scene =
      read_scenario(BBSIM_SOURCE_DIR "/configs/fig2b.yaml", {"time.end=1e6", "time.step=1000"});
  const Run run = run_in_memory(scene, method, {1e-7, 1e-9}, false);
  REQUIRE(run.outcome.ending == solve::Ending::done);
  CHECK(run.outcome.statistics.steps < 1'000'000);
  const auto radius = [&](std::size_t i) {
    return std::hypot(run.samples[i].ball.x, run.samples[i].ball.y);
  };
  for (std::size_t i = 20; i < run.samples.size(); ++i) {
    // The radii agree to the effect of a hundred steps of 1e-7, times the 1000 s in which the slow
    // mode decays, over the 20 s of a lap.
    CHECK(std::abs(radius(i) - radius(20)) < 5e-4);
  }
}

TEST_CASE("forward and back again") {
  const Method method = GENERATE(Method::automatic, Method::radau, Method::bdf, Method::adams);
  CAPTURE(name_of(method));
  const solve::Tolerances tolerances{1e-10, 1e-12};
  const Scenario there = hard_case("there-and-back");
  const double end = there.time.end;
  const Run forwards = run_in_memory(there, method, tolerances);
  REQUIRE(forwards.outcome.ending == solve::Ending::done);
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
  const Run backwards = run_in_memory(back, method, tolerances);
  REQUIRE(backwards.outcome.ending == solve::Ending::done);
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

}  // namespace bbsim_test::test_long_and_short
