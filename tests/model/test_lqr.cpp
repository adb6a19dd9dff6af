// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Riccati equations, LQR gains, and the poles of sampled loops.
#include <Eigen/Core>
#include <cmath>
#include <complex>

#include "base/error.hpp"
#include "catch.hpp"
#include "model/assemble.hpp"
#include "model/control/riccati.hpp"
#include "model/control/sample_times.hpp"
#include "model/control/sampled_cycle.hpp"
#include "model/dense.hpp"
#include "model/spectrum.hpp"
#include "support/run_in_memory.hpp"
#include "support/scenes.hpp"

namespace bbsim_test::test_lqr {

using namespace bbsim;
using Eigen::MatrixXd;
using model::operator*;  // compiles in a fraction of the time of Eigen's

namespace {

MatrixXd one(double value) {
  return MatrixXd::Constant(1, 1, value);
}

Scenario lqr_scene(bool sampled) {
  Scenario scene = fig2b();
  scene.ball.radius = 0.02;
  scene.ball.position = {0.05, -0.03};
  scene.gimbal.servo = Servo{30, 0.8};
  scene.controller->law = Law::lqr;
  scene.controller->weights = {100, 1, 0, 0, 1};
  scene.controller->reference = PointReference{};
  if (sampled) scene.controller->sampling = Sampling{0.02, 0, 0, 0};
  scene.time = {8, 0.02};
  return scene;
}

}  // namespace

TEST_CASE("Riccati equations with known solutions") {
  // x+ = x + u, cost x^2 + u^2: X = 1 + X / (1 + X), the golden ratio.
  const auto discrete = model::solve_discrete_riccati(one(1), one(1), one(1), one(1));
  const double golden = (1 + std::sqrt(5.0)) / 2;
  CHECK(discrete.cost(0, 0) == Approx(golden).epsilon(1e-14));
  CHECK(discrete.gain(0, 0) == Approx(golden / (1 + golden)).epsilon(1e-14));

  // The double integrator, cost x^2 + u^2: K = (1, sqrt 2).
  MatrixXd a(2, 2), b(2, 1), q(2, 2);
  a << 0, 1, 0, 0;
  b << 0, 1;
  q << 1, 0, 0, 0;
  const auto continuous = model::solve_continuous_riccati(a, b, q, one(1));
  CHECK(continuous.gain(0, 0) == Approx(1).epsilon(1e-13));
  CHECK(continuous.gain(0, 1) == Approx(std::sqrt(2.0)).epsilon(1e-13));

  // An unobserved growing mode has a gain, but no stabilizing one.
  MatrixXd modes(2, 2), first(2, 1), seen(2, 2);
  modes << 0.5, 0, 0, 2;
  first << 1, 0;
  seen << 1, 0, 0, 0;
  CHECK_THROWS_AS(model::solve_discrete_riccati(modes, first, seen, one(1)), InputError);

  // An uncontrollable mode that does not decay has no solution.
  CHECK_THROWS_AS(model::solve_continuous_riccati(a, MatrixXd::Zero(2, 1), q, one(1)), InputError);
}

TEST_CASE("LQR gains of the rig solve their equation and stabilize it") {
  const auto built = model::assemble_rig<true>(lqr_scene(false), {});
  const model::LinearPlant plant = model::plant_at_home(built.loop);
  const LqrWeights weights = lqr_scene(false).controller->weights;
  const MatrixXd gain = model::lqr_gain(plant, weights, 0);
  const MatrixXd closed = plant.a - plant.b * gain;
  for (const auto& pole : model::sorted_eigenvalues(closed)) CHECK(pole.real() < -0.1);

  const model::LinearPlant step = model::zero_order_hold(plant, 0.02);
  const MatrixXd sampled = model::lqr_gain(plant, weights, 0.02);
  const MatrixXd map = step.a - step.b * sampled;
  for (const auto& pole : model::sorted_eigenvalues(map)) CHECK(std::abs(pole) < 0.999);

  // The residual of the continuous equation, with the cost matrix of this gain.
  MatrixXd q = MatrixXd::Zero(8, 8);
  q.diagonal() << 100, 100, 1, 1, 0, 0, 0, 0;
  const auto solved =
      model::solve_continuous_riccati(plant.a, plant.b, q, MatrixXd::Identity(2, 2));
  const MatrixXd& x = solved.cost;
  const MatrixXd quadratic = x * plant.b * model::transposed(plant.b) * x;
  const MatrixXd residual = model::transposed(plant.a) * x + x * plant.a - quadratic + q;
  // Rounding of the largest term, times the doubling's conditioning of some thousand.
  CHECK(residual.norm() < 1e-12 * quadratic.norm());
}

namespace {

// Without sensor and servo errors a small motion is linear: a cycle of samples multiplies the state
// by a matrix M. From cycle to cycle x then satisfies the recurrence with the coefficients of M's
// characteristic polynomial (Cayley-Hamilton).
void check_recurrence(const Scenario& scene, std::size_t samples) {
  const model::Model model = model::assemble(scene, false);
  const auto poles = model::sampled_poles(model);
  std::vector<std::complex<double>> polynomial{1};  // by descending powers
  for (const auto& pole : poles) {
    polynomial.push_back(0);
    for (std::size_t i = polynomial.size() - 1; i > 0; --i)
      polynomial[i] -= pole * polynomial[i - 1];
  }
  const Run run = whole_run(scene, Method::automatic, {1e-11, 1e-19}, false);
  const std::size_t n = poles.size();
  int instants = 0;
  // Start when all exposures from before the start have passed the delays.
  for (std::size_t from = 5; from + n * samples < run.samples.size(); ++from) {
    if (from % samples != 0) continue;
    double sum = 0, sizes = 0;
    for (std::size_t i = 0; i <= n; ++i) {
      const double term = polynomial[i].real() * run.samples[from + (n - i) * samples].ball.x;
      sum += term;
      sizes += std::abs(term);
    }
    // An unstable loop, because of its delays, leaves the linear range.
    if (std::abs(run.samples[from + n * samples].gimbal.phi) > 1e-4) break;
    // A hundred times the tolerance; nonlinear terms, quadratic in the angles, are smaller.
    CHECK(std::abs(sum) < 1e-9 * sizes);
    ++instants;
  }
  CHECK(instants > 0);
}

Scenario small_motion(Law law, bool first_order) {
  Scenario scene = lqr_scene(true);
  scene.controller->law = law;
  scene.controller->kp = {{{0.4, 0}, {0, -0.4}}};
  scene.controller->kv = {{{0.35, 0}, {0, -0.35}}};
  scene.controller->ki = {{{0.1, 0}, {0, -0.1}}};
  if (scene.controller->law != Law::pid) scene.controller->ki = {};
  if (first_order) {
    Servo servo;
    servo.time_constant = 0.05;
    scene.gimbal.servo = servo;
  }
  scene.controller->sensor = Sensor{};
  scene.ball.position = {1e-7, 0};
  return scene;
}

}  // namespace

TEST_CASE("from cycle to cycle a small motion satisfies the polynomial of the sampled poles") {
  struct Timing {
    double command, sensor;        // delays, s
    double period = 0, phase = 0;  // of a camera, if it has one
    std::size_t samples = 1;       // per cycle: 20 ms each, after which frames and samples coincide
  };
  std::vector<Timing> timings{{0, 0}, {0.013, 0}, {0.02, 0.01}, {0.03, 0.055}};
  for (const double delay : {0.0, 0.013, 0.02}) {
    timings.insert(timings.end(), {{delay, 0, 0.02, 0.001},
                                   {delay, 0, 0.02, 0},
                                   {delay, 0.03, 0.02, 0.013},
                                   {delay, 0.004, 0.005, 0.003},
                                   {delay, 0.012, 0.03, 0.004, 3},
                                   {delay, 0, 0.04 / 3, 0.002, 2},
                                   {delay, 0.02, 0.04, 0.02, 2},
                                   {delay, 0.021, 0.05, 0.013, 5},
                                   {delay, 0.05, 0.03, 0, 3}});  // seen exactly at a sample
  }
  // An LQR needs a second-order servo.
  const auto [law, first_order] =
      GENERATE(std::pair{Law::pd, false}, std::pair{Law::pd, true}, std::pair{Law::pid, false},
               std::pair{Law::pid, true}, std::pair{Law::lqr, false});
  for (const Timing& of : timings) {
    CAPTURE(int(law), first_order, of.command, of.sensor, of.period, of.phase);
    Scenario scene = small_motion(law, first_order);
    scene.controller->sampling = Sampling{0.02, of.command, 0, 0.03};
    scene.controller->sensor->delay = of.sensor;
    if (of.period > 0) {
      scene.controller->sensor->period = of.period;
      scene.controller->sensor->phase = of.phase;
      const model::CommonCycle cycle =
          model::common_cycle(*scene.controller->sampling, *scene.controller->sensor);
      REQUIRE(cycle.known);
      REQUIRE(cycle.samples == static_cast<double>(of.samples));
    }
    scene.time = {2 + 0.4 * static_cast<double>(of.samples), 0.02};
    check_recurrence(scene, of.samples);
  }
}

TEST_CASE("frames that never coincide with samples, or jitter, are not in the poles") {
  Scenario scene = small_motion(Law::pd, false);
  scene.controller->sampling = Sampling{0.02, 0.004, 0, 0.03};
  const auto plain = model::sampled_poles(model::assemble(scene, false));
  scene.controller->sensor->period = 0.02 / std::sqrt(2.0);
  CHECK_FALSE(model::common_cycle(*scene.controller->sampling, *scene.controller->sensor).known);
  CHECK(model::sampled_poles(model::assemble(scene, false)) == plain);
  scene.controller->sensor->period = 0.02;
  scene.controller->sensor->phase = 0.001;
  CHECK(model::sampled_poles(model::assemble(scene, false)) != plain);
  scene.controller->sampling->jitter = 1e-4;
  CHECK_FALSE(model::common_cycle(*scene.controller->sampling, *scene.controller->sensor).known);
  CHECK(model::sampled_poles(model::assemble(scene, false)) == plain);
}

}  // namespace bbsim_test::test_lqr
