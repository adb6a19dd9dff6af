// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Loops in lanes against the collocation integrator run one by one. Their greatest values, events
// and interrupts are in tests/sweep.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "catch.hpp"
#include "simd/instruction_set.hpp"
#include "solve/ensemble_runs.hpp"
#include "solve/integrate.hpp"
#include "solve/radau/radau.hpp"
#include "support/run_in_memory.hpp"

namespace bbsim_test::test_closed_loops {

using namespace bbsim;
using namespace bbsim::solve::ensemble;

namespace {

template <Drives drives>
Case loop_case(const Scenario& scene) {
  using Loop = model::ClosedLoop<model::Shape::full, drives>;
  const model::Model model = model::assemble(scene, false);
  const model::SignalView path = std::get<Loop>(model.system).reference().view();
  REQUIRE(path.harmonic_count <= 1);
  Case one{};
  one.radius = scene.ball.radius;
  one.gravity = scene.gravity;
  if (scene.gimbal.servo) {
    one.omega_n = scene.gimbal.servo->natural_frequency;
    one.zeta = scene.gimbal.servo->damping;
  }
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t j = 0; j < 2; ++j) {
      one.kv[i][j] = scene.controller->kv[i][j];
      one.kp[i][j] = scene.controller->kp[i][j];
    }
    one.start[i] = path.start[i];
    one.rate[i] = path.rate[i];
  }
  one.harmonic_count = static_cast<int>(path.harmonic_count);
  std::copy_n(path.harmonics, path.harmonic_count, one.harmonics);
  std::copy(model.initial.begin(), model.initial.end(), one.initial);
  return one;
}

Case case_of(const Scenario& scene) {
  return scene.controller->drives == Drives::angle ? loop_case<Drives::angle>(scene)
                                                   : loop_case<Drives::acceleration>(scene);
}

Actuation actuation_of(const Scenario& scene) {
  return scene.controller->drives == Drives::angle ? Actuation::by_servo
                                                   : Actuation::by_acceleration;
}

// Scenes with gains within 30 % of the given scene's.
std::vector<Scenario> with_other_gains(const Scenario& scene, std::size_t count) {
  std::mt19937_64 random(42);
  std::uniform_real_distribution<double> factor(0.7, 1.3);
  std::vector<Scenario> scenes(count, scene);
  for (Scenario& one : scenes) {
    for (auto* gains : {&one.controller->kv, &one.controller->kp}) {
      for (auto& row : *gains) {
        for (double& gain : row) gain *= factor(random);
      }
    }
  }
  return scenes;
}

std::vector<Case> cases_of(const std::vector<Scenario>& scenes) {
  std::vector<Case> cases;
  for (const Scenario& scene : scenes) cases.push_back(case_of(scene));
  return cases;
}

solve::Trajectory truth(const Scenario& scene) {
  const model::Model model = model::assemble(scene, false);
  solve::Trajectory rows(model.row_size());
  const solve::OutputGrid grid(scene.time);
  REQUIRE(solve::integrate(model, Method::radau, {1e-12, 1e-14}, grid, rows, {}).ending ==
          solve::Ending::done);
  return rows;
}

// Largest position error over all rows, m.
double error_of(const Course& run, const Scenario& scene) {
  const solve::Trajectory exact = truth(scene);
  REQUIRE(run.x.size() == exact.rows());
  double worst = 0;
  for (std::size_t row = 0; row < exact.rows(); ++row) {
    for (const double apart :
         {std::abs(run.x[row] - exact.row(row)[0]), std::abs(run.y[row] - exact.row(row)[1])}) {
      worst = apart <= worst ? worst : apart;  // a maximum would ignore NaN
    }
  }
  return worst;
}

// Local error at this tolerance, m, with the ball within 0.1 m.
double local_error(solve::Tolerances tolerances) {
  return tolerances.rtol * 0.1 + tolerances.atol;
}

Scenario short_literal() {
  Scenario scene = scenario_named("fig2b-literal");
  scene.time = {1, 0.05};
  return scene;
}

}  // namespace

TEST_CASE("loops in lanes follow collocation at every tolerance") {
  const char* name = GENERATE("fig2b", "stiff-servo", "fig2b-literal");
  const double rtol = GENERATE(1e-4, 1e-7, 1e-10, 1e-12);
  Scenario scene = scenario_named(name);
  // The loop as printed diverges, but long before 0.7 s it behaves like others.
  if (scene.controller->drives == Drives::acceleration) scene.time = {0.3, 0.01};
  const std::vector<Scenario> scenes = with_other_gains(scene, group);
  const int nodes = GENERATE(8, 12);
  const solve::Tolerances tolerances{rtol, rtol / 100};
  Ensemble lanes({actuation_of(scene), solve::OutputGrid(scene.time)}, nodes, tolerances);
  const auto runs = carry(lanes, cases_of(scenes));
  CHECK(are_done(runs));
  for (std::size_t i = 0; i < group; ++i) {
    CAPTURE(name, rtol, nodes, i);
    // Some tens of steps, whose errors a stable loop damps out.
    CHECK(error_of(runs[i], scenes[i]) < 10 * local_error(tolerances));
    // The polynomial's end and the last node agree up to rounding.
    CHECK(runs[i].x.back() == Approx(runs[i].state[0]).epsilon(1e-12).margin(1e-16));
    CHECK(runs[i].y.back() == Approx(runs[i].state[1]).epsilon(1e-12).margin(1e-16));
  }
}

TEST_CASE("the error of a step has the order of the method") {
  const Scenario base = scenario_named("fig2b");
  const auto error_at = [&](double h) {
    Scenario scene = base;
    scene.time = {2, 2};
    scene.gimbal.start = {0.05, -0.03, 0, 0};
    const Case one = case_of(scene);
    const Kernel& kernel = kernel_of(kernels<simd::Baseline>(), Actuation::by_servo, 8);
    std::vector<double> memory(kernel.workspace / sizeof(double) + 8);
    void* place = memory.data();
    std::size_t space = memory.size() * sizeof(double);
    void* const workspace = std::align(64, kernel.workspace, place, space);
    Progress state{one, {}, {}, 0, {}};
    std::copy_n(one.initial, states, state.state);
    kernel.start(workspace, {1e-6, 1e-8, {}});
    for (int lane = 0; lane < group; ++lane) kernel.load(workspace, lane, state);
    Attempt attempt;
    Spans spans;
    Lanes all;
    std::fill(std::begin(all.of), std::end(all.of), -1);
    const int steps = static_cast<int>(std::lround(2 / h));
    for (int i = 0; i < steps; ++i) {
      std::fill(std::begin(spans.from), std::end(spans.from), i * h);
      std::fill(std::begin(spans.length), std::end(spans.length), h);
      kernel.attempt(workspace, spans, attempt);
      kernel.accept(workspace, all, all);
    }
    kernel.store(workspace, 3, state);
    const solve::Trajectory exact = truth(scene);
    return std::hypot(state.state[0] - exact.row(1)[0], state.state[1] - exact.row(1)[1]);
  };
  // At step ends Radau IIA with eight nodes has order 15, between nodes 8.
  CHECK(std::log2(error_at(1) / error_at(0.5)) > 10);
}

TEST_CASE("a stiff servo does not reduce the order of loops in lanes") {
  const Scenario scene = scenario_named("stiff-servo");
  const std::vector<Case> cases = cases_of(with_other_gains(scene, group));
  const auto steps_at = [&](double rtol) {
    Ensemble lanes({Actuation::by_servo, solve::OutputGrid(scene.time)}, 8, {rtol, rtol / 100});
    CHECK(are_done(carry(lanes, cases)));
    // A Jacobian far from those of the nodes would take ten iterations.
    CHECK(static_cast<double>(lanes.statistics().nonlinear_iterations) <
          3.5 * static_cast<double>(lanes.statistics().jacobian_evaluations));
    return static_cast<double>(lanes.statistics().steps) / group;
  };
  // A factor of four with order 8, and ten with a method that loses order.
  CHECK(steps_at(1e-10) / steps_at(1e-5) < 5);
  CHECK(steps_at(1e-4) < 25);
}

TEST_CASE("the result of a loop depends neither on its companions nor on earlier runs") {
  const auto [set, width] =
      GENERATE(table<const char*, int>({{"sse2", 2}, {"avx2", 4}, {"avx512", 8}}));
  if (!simd::find_instruction_set(set)) return;
  setenv("BBSIM_SIMD", set, 1);
  CHECK(choose_kernels().width == width);
  // Gains of both signs, some large: a third of the loops with the slow servo diverge, to angles
  // too large for the packs' sine. One loop has a reference as fast.
  const std::string name = GENERATE("fig2b", "stiff-servo");
  const Scenario scene = scenario_named(name);
  std::vector<Scenario> scenes = with_other_gains(scene, 40);
  for (std::size_t i = 0; i < scenes.size(); i += 3) scenes[i].controller->kv[0][0] *= -0.3;
  for (std::size_t i = 1; i < scenes.size(); i += 9) scenes[i].controller->kv[0][0] *= -8;
  std::vector<Case> cases = cases_of(scenes);
  cases[11].harmonic_count = 1;
  cases[11].harmonics[0].frequency = 3e4;
  const double rtol = GENERATE(1e-5, 1e-8);
  CAPTURE(set, name, rtol);
  const solve::Tolerances tolerances{rtol, rtol / 100};
  Ensemble lanes({Actuation::by_servo, solve::OutputGrid(scene.time)},
                 choose_nodes(Actuation::by_servo, rtol), tolerances);
  unsetenv("BBSIM_SIMD");
  const std::vector<Course> together = carry_in_any_company(lanes, cases);
  CHECK(error_of(together[2], scenes[2]) < 10 * local_error(tolerances));
  const auto unbounded = std::ranges::count(together, Ending::unbounded, &Course::ending);
  if (name == "fig2b") CHECK(unbounded > 8);
  CHECK(unbounded < 25);
}

TEST_CASE("a diverging loop ends where a single run does, and others continue") {
  const bool alone = GENERATE(false, true);
  Scenario literal = short_literal();  // singular at 0.75 s
  Scenario mild = literal;
  mild.controller->kv = {{{2, 0}, {0, -2}}};
  mild.controller->kp = {{{1, 0}, {0, -1}}};
  std::vector<Scenario> scenes = with_other_gains(mild, group);
  const std::vector<std::size_t> bad = {2, 5};
  for (std::size_t i : bad) scenes[i] = literal;
  if (alone) scenes.assign(1, literal);
  const solve::Tolerances tolerances{1e-8, 1e-10};
  const solve::OutputGrid grid(literal.time);
  Ensemble lanes({Actuation::by_acceleration, grid}, 12, tolerances);
  const auto runs = carry(lanes, cases_of(scenes));
  solve::Trajectory single(model::assemble(literal, false).row_size());
  const solve::Outcome outcome = solve::integrate(model::assemble(literal, false), Method::radau,
                                                  {1e-10, 1e-12}, grid, single, {});
  REQUIRE(outcome.reason == solve::Shrinking::reason.text);
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    CAPTURE(i);
    if (!alone && std::count(bad.begin(), bad.end(), i) == 0) {
      REQUIRE(runs[i].ending == Ending::done);
      CHECK(error_of(runs[i], scenes[i]) < 10 * local_error(tolerances));
      continue;
    }
    CHECK(runs[i].ending == Ending::unbounded);
    // Both end when a step is shorter than 1e-5 of the time.
    CHECK(runs[i].reached == Approx(outcome.reached).epsilon(1e-4));
    REQUIRE(runs[i].x.size() == single.rows());
    for (std::size_t row = 0; row < single.rows(); ++row) {
      CHECK(runs[i].x[row] == Approx(single.row(row)[0]).epsilon(1e-3).margin(1e-9));
      CHECK(runs[i].y[row] == Approx(single.row(row)[1]).epsilon(1e-3).margin(1e-9));
    }
  }
}

TEST_CASE("a loop that explodes ends long before its steps vanish") {
  // Near the singularity each step is 5 % shorter than the previous one: 600 steps from the start
  // to rounding.
  const double gain = GENERATE(-10.0, -1.0, -0.1);
  Scenario scene = scenario_named("fig2b");
  scene.controller->kv[0][0] = gain;
  Ensemble lanes({Actuation::by_servo, solve::OutputGrid(scene.time)}, 8, {1e-6, 1e-9});
  const auto runs = carry(lanes, {case_of(scene)});
  CHECK(runs[0].ending == Ending::unbounded);
  CHECK(lanes.statistics().steps < 200);
}

TEST_CASE("a loop of NaN is abandoned, the others continue") {
  const Scenario scene = scenario_named("fig2b");
  const std::vector<Scenario> scenes = with_other_gains(scene, group);
  std::vector<Case> cases = cases_of(scenes);
  const double bad =
      GENERATE(std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity());
  cases[3].kv[0][0] = bad;
  const solve::Tolerances tolerances{1e-6, 1e-8};
  Ensemble lanes({Actuation::by_servo, solve::OutputGrid(scene.time)}, 8, tolerances);
  const auto runs = carry(lanes, cases);
  for (std::size_t i = 0; i < group; ++i) {
    CHECK(runs[i].ending == (i == 3 ? Ending::given_up : Ending::done));
    if (i != 3) CHECK(error_of(runs[i], scenes[i]) < 10 * local_error(tolerances));
  }
}

TEST_CASE("loops whose gains couple the axes cost no more") {
  Scenario scene = scenario_named("fig2b");
  scene.controller->kv = {{{0.8, 0.5}, {0.4, -0.9}}};
  const solve::Tolerances tolerances{1e-9, 1e-11};
  Ensemble lanes({Actuation::by_servo, solve::OutputGrid(scene.time)}, 12, tolerances);
  const auto runs = carry(lanes, cases_of({scene}));
  CHECK(are_done(runs));
  CHECK(error_of(runs[0], scene) < 10 * local_error(tolerances));
  CHECK(lanes.statistics().nonlinear_iterations < 4 * lanes.statistics().jacobian_evaluations);
}

}  // namespace bbsim_test::test_closed_loops
