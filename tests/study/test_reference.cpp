// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The quad-precision reference against solutions by an independent method, and closed forms.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>
#include <vector>

#include "base/quad.hpp"
#include "catch.hpp"
#include "reference_table.hpp"
#include "scenario/reader.hpp"
#include "solve/integrate.hpp"
#include "study/checks.hpp"
#include "study/reference.hpp"

namespace bbsim_test::test_reference {

using bbsim::plain;
using bbsim::Quad;
using bbsim::Scenario;
using bbsim::study::ReferenceSolution;

namespace {

Scenario scene(const std::string& name, const std::vector<std::string>& overrides = {}) {
  return bbsim::read_scenario(BBSIM_SOURCE_DIR "/tests/data/scenarios/" + name + ".yaml",
                              overrides);
}

ReferenceSolution solve(const Scenario& scenario, double tolerance = 1e-22) {
  const bbsim::solve::OutputGrid grid(scenario.time);
  return bbsim::study::solve_reference(bbsim::model::assemble(scenario, true), grid, tolerance);
}

// The scenario's numbers that are not exact as doubles: 0.3, but not 5 or 0.25.
std::vector<double*> rounded_parameters(Scenario& scenario) {
  std::vector<double*> all{&scenario.gravity,          &scenario.ball.radius,
                           &scenario.ball.position[0], &scenario.ball.position[1],
                           &scenario.ball.velocity[0], &scenario.ball.velocity[1],
                           &scenario.ball.spin};
  if (scenario.gimbal.motion) {
    for (auto* profile : {&scenario.gimbal.motion->phi, &scenario.gimbal.motion->theta}) {
      for (auto& term : *profile) {
        if (auto* wave = std::get_if<bbsim::Sinusoid>(&term)) {
          all.insert(all.end(), {&wave->amplitude, &wave->phase, &wave->offset});
        }
      }
    }
  }
  if (scenario.controller) {
    for (auto* gains : {&scenario.controller->kv, &scenario.controller->kp}) {
      for (auto& row : *gains) all.insert(all.end(), {&row[0], &row[1]});
    }
    auto& circle = std::get<bbsim::CircleReference>(scenario.controller->reference);
    all.insert(all.end(), {&circle.radius, &circle.rate, &circle.phase});
  }
  std::vector<double*> rounded;
  for (double* value : all) {
    if (*value * 1024 != std::floor(*value * 1024)) rounded.push_back(value);
  }
  return rounded;
}

bbsim::solve::Trajectory solve_in_double(const Scenario& scenario) {
  const auto model = bbsim::model::assemble(scenario, false);
  const bbsim::solve::OutputGrid grid(scenario.time);
  bbsim::solve::Trajectory rows(model.size());
  const auto outcome =
      bbsim::solve::integrate(model, bbsim::Method::automatic, {1e-12, 1e-14}, grid, rows);
  REQUIRE(outcome.ending == bbsim::solve::Ending::done);
  return rows;
}

// The largest change in x or y, in m, from rounding the parameters: each one is changed by 1e-6,
// and the change of the solution scaled down to half a unit in the last place, 1.1e-16. Double
// precision gives that change to three digits or more.
double effect_of_rounding(Scenario scenario) {
  const int coordinates = bbsim::study::coordinates(bbsim::model::assemble(scenario, false));
  const auto base = solve_in_double(scenario);
  double sum = 0;
  for (double* parameter : rounded_parameters(scenario)) {
    const double value = *parameter;
    *parameter = value * (1 + 1e-6);
    const auto changed = solve_in_double(scenario);
    *parameter = value;
    double largest = 0;
    for (std::size_t i = 0; i < base.rows(); ++i) {
      for (int c = 0; c < coordinates; ++c) {
        largest = std::max(largest, std::abs(base.row(i)[c] - changed.row(i)[c]));
      }
    }
    sum += largest * 1.1e-10;
  }
  return sum;
}

}  // namespace

TEST_CASE("the reference agrees with solutions by an independent method") {
  const auto name = GENERATE(as<std::string>{}, "fig2a", "small-ball", "spin", "fast", "tumble",
                             "fig2b", "stiff-servo", "fig2b-literal");
  CAPTURE(name);
  // This table ends before its scene, which diverges.
  const Scenario scenario = name == "fig2b-literal" ? scene(name, {"time.end=0.6"}) : scene(name);
  const auto model = bbsim::model::assemble(scenario, true);
  const bbsim::solve::OutputGrid grid(scenario.time);
  const ReferenceSolution solution = bbsim::study::solve_reference(model, grid);
  const auto table = read_reference_table(name);
  REQUIRE(solution.complete);
  REQUIRE(solution.rows() == table.size());

  // Parameters round once when read, and once more in products such as 7 r or omega_n^2, each of
  // which enters at most three terms: four times the effect of the first rounding covers both.
  const double allowed = 4 * effect_of_rounding(scenario);
  CAPTURE(allowed);
  double worst = 0;
  for (std::size_t i = 0; i < table.size(); ++i) {
    // The grid's times are rounded too: 49 * 0.1 is no double. To first order that moves x by vx
    // times the difference; the second order, 1e-31 of an acceleration, is negligible.
    const Quad late = Quad(grid[i]) - table[i][0];
    for (std::size_t c = 0; c < 2; ++c) {
      const Quad expected = table[i][1 + c] + table[i][3 + c] * late;
      worst = std::max(worst, plain(abs(solution.row(i)[c] - expected)));
    }
  }
  CHECK(worst < allowed);
  // This makes the comparison significant: it sees the sixteenth digit of the scene's size.
  double size = 0.1;
  for (const auto& row : table) size = std::max(size, plain(abs(row[1])));
  CHECK(allowed < 1e-12 * size);

  // Steps meet 1e-22 and 1e-21 of 1 + |z|, and in no scene do errors grow by more than the 1e5 by
  // which the states do.
  CHECK(solution.error_estimate < 1e-16 * size);
  if (name == "fig2a" || name == "fig2b" || name == "stiff-servo" || name == "small-ball") {
    CHECK(solution.error_estimate < 1e-20);  // well-behaved: nothing grows
  }
}

TEST_CASE("the reference's gamma and states agree with the independent method") {
  const Scenario scenario = scene("spin");
  const auto table = read_reference_table("spin");
  const ReferenceSolution solution = solve(scenario);
  const double radius = scenario.ball.radius;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const Quad* row = solution.row(i);
    // Rounding errors, 1.1e-16 each, in a handful of parameters and in t; values up to 500, which
    // the table gives to 21 digits.
    CHECK(plain(abs(row[2] - table[i][3])) < 1e-14);
    CHECK(plain(abs(row[3] - table[i][4])) < 1e-14);
    CHECK(plain(abs(row[4] / radius - table[i][5])) < 5e-14);
    CHECK(plain(abs(row[5] / radius - table[i][6])) < 5e-13);
  }
}

TEST_CASE("the reference agrees with a closed form to twenty digits and more") {
  // phi = 2 t, with all numbers exact in binary: x = A cosh kt + B sinh kt - (5 g / 48) sin 2t with
  // k = 2 sqrt(5/7), from docs/explanation/model.md. The sums below evaluate cosh and sinh.
  const double g = 9.8125, x0 = 0.0625;
  Scenario scenario;
  scenario.gravity = g;
  scenario.ball.radius = 0.015625;
  scenario.ball.position = {x0, 0};
  scenario.gimbal.motion = bbsim::GimbalMotion{{bbsim::Ramp{0, 2}}, {}};
  scenario.time = {5, 0.125};
  const bbsim::solve::OutputGrid grid(scenario.time);
  const ReferenceSolution solution = solve(scenario);
  REQUIRE(solution.complete);
  REQUIRE(solution.row_size == 2);

  const Quad k_squared = Quad(20.0) / 7;
  Quad k = std::sqrt(20.0 / 7.0);
  for (int pass = 0; pass < 3; ++pass) k = (k + k_squared / k) / 2;
  const Quad forced = Quad(5 * g) / 48;
  for (std::size_t i = 0; i < solution.rows(); ++i) {
    const Quad t = grid[i];
    Quad cosh = 0.0, sinh = 0.0, term = 1.0;
    for (int n = 0; n < 80; n += 2) {
      cosh += term;
      term = term * k * t / (n + 1);
      sinh += term;
      term = term * k * t / (n + 2);
    }
    const Quad x = x0 * cosh + 2 * forced / k * sinh - forced * sin_cos(2 * t).sin;
    // The step's tolerance, 1e-22 of 1 + |z|, in each of a few steps; |z| reaches 5000, and an
    // early error grows as fast as x.
    CHECK(plain(abs(solution.row(i)[0] - x)) < 1e-21 * (1 + std::abs(plain(x))));
  }
  CHECK(solution.error_estimate < 1e-17);
}

TEST_CASE("a looser tolerance of the reference takes fewer steps and is met") {
  const Scenario scenario = scene("fast");
  const ReferenceSolution fine = solve(scenario);
  const ReferenceSolution loose = solve(scenario, 1e-12);
  CHECK(loose.steps < fine.steps / 2);
  double error = 0;
  for (std::size_t i = 0; i < fine.rows(); ++i) {
    for (int c = 0; c < 2; ++c) {
      error = std::max(error, plain(abs(fine.row(i)[c] - loose.row(i)[c])));
    }
  }
  // The estimate is the error of a solution with ten times the tolerance.
  CHECK(error < loose.error_estimate);
  // Steps meet 1e-11 of 1 + |z|, and |z| reaches 7000.
  CHECK(loose.error_estimate < 1e-11 * 7000);
}

TEST_CASE("for the reference a servo of 20000 rad/s takes hardly more steps than one of 2000") {
  // A tenth of the scene's gains: r k_v omega_n must stay below 2 zeta.
  const std::vector<std::string> gains{"controller.pd.kv=[[0.005, 0], [0, -0.005]]",
                                       "controller.pd.kp=[[0.005, 0], [0, -0.005]]"};
  auto stiffer = gains;
  stiffer.emplace_back("gimbal.servo.natural_frequency=20000");
  const ReferenceSolution once = solve(scene("stiff-servo", gains));
  const ReferenceSolution tenfold = solve(scene("stiff-servo", stiffer));
  CHECK(tenfold.complete);
  CHECK(tenfold.error_estimate < 1e-20);  // nothing grows, as above
  CHECK(tenfold.steps < 3 * once.steps);
}

TEST_CASE("the reference of a diverging solution ends before the singularity") {
  const ReferenceSolution solution = solve(scene("fig2b-literal"));
  CHECK_FALSE(solution.complete);
  CHECK(solution.rows() == 75);  // t = 0 ... 0.74 s, steps of 0.01 s
  CHECK(solution.reached == Approx(0.7488).epsilon(1e-4));
  CHECK(solution.reason.find("vy") != std::string::npos);
}

TEST_CASE("the reference stops at every knot of a table") {
  Scenario scenario;
  scenario.ball.radius = 0.015625;
  scenario.gravity = 9.8125;
  scenario.ball.position = {0.0625, 0};
  const bbsim::Table bump{"", {0, 0.25, 0.5, 1, 1.5, 2}, {0, 0.125, 0.0625, -0.125, 0.25, 0}};
  scenario.gimbal.motion = bbsim::GimbalMotion{{bump}, {}};
  scenario.time = {2, 0.125};
  const ReferenceSolution solution = solve(scenario);
  REQUIRE(solution.complete);
  CHECK(solution.steps >= 5);  // at least one per piece
  // Nothing grows here. Two step sequences across the jumps of the third derivative would not agree
  // to 1e-6.
  CHECK(solution.error_estimate < 1e-20);
}

TEST_CASE("the reference does not step over a jump of the controller's reference") {
  Scenario scenario = scene("fig2b");
  scenario.controller->reference = bbsim::StaircaseReference{{{0.05, 0}, {0.04, 0.01}}, {0.75}};
  scenario.time = {1.5, 0.125};
  const ReferenceSolution solution = solve(scenario);
  REQUIRE(solution.complete);
  // Two rules with different nodes agree only if neither has a node beyond the jump.
  CHECK(solution.error_estimate < 1e-20);
  const auto rows = solve_in_double(scenario);
  for (std::size_t i = 0; i < rows.rows(); ++i) {
    for (int c = 0; c < 2; ++c) {
      CAPTURE(i, c);
      // Some tens of steps, each with an error of 1e-12 for states below 1.
      CHECK(std::abs(rows.row(i)[c] - plain(solution.row(i)[c])) < 1e-10);
    }
  }
}

TEST_CASE("a reference can be interrupted, and reports its progress") {
  const Scenario scenario = scene("fast");
  const bbsim::solve::OutputGrid grid(scenario.time);
  const auto model = bbsim::model::assemble(scenario, false);
  std::atomic<bool> stop = false;
  double last = 0;
  bool rising = true;
  bbsim::solve::Watch watch{&stop, [&](double time) {
                              rising = rising && time >= last;
                              last = time;
                              if (time > 7) stop = true;
                            }};
  const ReferenceSolution solution = bbsim::study::solve_reference(model, grid, 1e-22, watch);
  CHECK(rising);
  CHECK_FALSE(solution.complete);
  CHECK(solution.reason.empty());
  CHECK(solution.reached < 10);
  CHECK(solution.rows() < grid.size());
}

}  // namespace bbsim_test::test_reference
