// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Shared by the hard cases: scenarios of configs/hard, quad references and a derived error bound.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "catch.hpp"
#include "scenario/reader.hpp"
#include "study/reference.hpp"
#include "support/run_in_memory.hpp"

namespace bbsim_test {

inline bbsim::Scenario hard_case(const std::string& name,
                                 const std::vector<std::string>& overrides = {}) {
  return bbsim::read_scenario(BBSIM_SOURCE_DIR "/configs/hard/" + name + ".yaml", overrides);
}

// Largest |x|, |y|, |x'|, |y'|, |r gamma'| up to and including row `last`, in m and m/s.
inline double size_until(const Run& run, double radius, std::size_t last) {
  double size = 0;
  for (std::size_t i = 0; i <= last && i < run.samples.size(); ++i) {
    const bbsim::model::BallMotion& ball = run.samples[i].ball;
    for (const double value : {ball.x, ball.y, ball.x_dot, ball.y_dot, radius * ball.gamma_dot}) {
      size = std::max(size, std::abs(value));
    }
  }
  return size;
}

// Error that the tolerances allow at row i. Each step may leave rtol |z| + atol in each state; in a
// speed it makes the position drift by that times the remaining time. In an exponentially growing
// scene errors grow like the solution, which `size_until` includes.
inline double allowance(const Run& run, bbsim::solve::Tolerances tolerances, double radius,
                        std::size_t i) {
  return static_cast<double>(run.outcome.statistics.steps) *
         (tolerances.rtol * size_until(run, radius, i) + tolerances.atol) * (1 + run.samples[i].t);
}

// x and y by quad-precision collocation, at the output times.
struct ExactRun {
  std::vector<double> x, y;
};

inline ExactRun quad_reference(const bbsim::Scenario& scene) {
  const bbsim::model::Model model = bbsim::model::assemble(scene, false);
  const bbsim::solve::OutputGrid grid(scene.time);
  const bbsim::study::ReferenceSolution solution =
      bbsim::study::solve_reference(model, grid, 1e-20);
  REQUIRE(solution.complete);
  ExactRun reference;
  for (std::size_t i = 0; i < solution.rows(); ++i) {
    std::vector<double> row(solution.row_size);
    for (std::size_t k = 0; k < row.size(); ++k) {
      row[k] = static_cast<double>(solution.row(i)[k]);
    }
    const bbsim::model::BallMotion ball = model.sample(grid[i], row.data()).ball;
    reference.x.push_back(ball.x);
    reference.y.push_back(ball.y);
  }
  return reference;
}

// Checks that the run is complete and every row within the tolerances' allowance.
inline void check_against(const ExactRun& reference, const Run& run,
                          bbsim::solve::Tolerances tolerances, double radius) {
  REQUIRE(run.outcome.ending == bbsim::solve::Ending::done);
  REQUIRE(run.samples.size() == reference.x.size());
  double worst = 0;  // error relative to the allowance
  for (std::size_t i = 1; i < run.samples.size(); ++i) {
    const bbsim::model::BallMotion& ball = run.samples[i].ball;
    const double error =
        std::max(std::abs(ball.x - reference.x[i]), std::abs(ball.y - reference.y[i]));
    REQUIRE(std::isfinite(error));
    worst = std::max(worst, error / allowance(run, tolerances, radius, i));
  }
  CAPTURE(run.outcome.statistics.steps, worst);
  CHECK(worst <= 1);
}

inline const char* name_of(bbsim::Method method) {
  for (const bbsim::NamedMethod& named : bbsim::named_methods) {
    if (named.method == method) return named.name.data();
  }
  return "";
}

}  // namespace bbsim_test
