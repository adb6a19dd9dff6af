// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// User error bounds, against quad-precision solutions.
#include <algorithm>
#include <cmath>
#include <string>

#include "catch.hpp"
#include "positions.hpp"
#include "study/error_control.hpp"
#include "support/run_in_memory.hpp"

namespace bbsim_test::test_error_control {

using namespace bbsim;

namespace {

struct Asked {
  study::ErrorControlled result;
  double error = 0;   // true error of x and y at the worst output time, m
  double extent = 0;  // largest coordinate, m
};

// Of a scene that has a quad-precision solution by another method.
Positions from_table(const std::string& name) {
  const QuadReference reference(name);
  Positions rows;
  for (std::size_t i = 0; i < reference["t"].size(); ++i) {
    rows.push_back({reference["x"][i], reference["y"][i]});
  }
  return rows;
}

// Runs a scene with a bound.
Asked ask(const model::Model& model, const solve::OutputGrid& grid, const Positions& truth,
          double bound, Method method = Method::automatic) {
  solve::Trajectory rows(model.row_size());
  Asked asked;
  asked.result = study::integrate_to_error(model, method, bound, grid, rows);
  for (std::size_t i = 0; i < std::min(rows.rows(), truth.size()); ++i) {
    for (std::size_t k = 0; k < truth[i].size(); ++k) {
      asked.error = std::max(asked.error, std::abs(rows.row(i)[k] - truth[i][k]));
      asked.extent = std::max(asked.extent, std::abs(truth[i][k]));
    }
  }
  return asked;
}

}  // namespace

TEST_CASE("the estimate is also honest if stops determine the steps") {
  // Tables, samples, a path through points, and monitors. Steps are as long as the pieces at any
  // tolerance, and so are those of a check at a finer one.
  const auto [name, end] =
      GENERATE(std::pair("recorded", "4"), std::pair("traced", "12"), std::pair("waypoints", "18"),
               std::pair("step", "2"), std::pair("catch", "1.5"), std::pair("falls", "8"));
  CAPTURE(name);
  const Scenario scene = read_scenario(std::string(BBSIM_SOURCE_DIR "/configs/") + name + ".yaml",
                                       {std::string("time.end=") + end});
  const model::Model model = model::assemble(scene, false);
  const solve::OutputGrid grid(scene.time);
  const Positions truth = exact_positions(model, grid);
  for (const double bound : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10}) {
    const Asked asked = ask(model, grid, truth, bound);
    CAPTURE(bound, asked.result.estimate, asked.error, asked.result.tolerances.rtol,
            asked.result.runs);
    CHECK(asked.result.outcome.ending != solve::Ending::failed);
    CHECK(asked.result.met);
    CHECK(asked.error <= bound);
    // The truth of a switching scene has a few rounding errors, amplified by the loop.
    const double known_to = (model.hybrid() ? 1e-13 : 4e-16) * asked.extent;
    CHECK(asked.result.estimate >= (asked.error - known_to) / 3);
    CHECK(asked.result.estimate <= 30 * asked.error + 100 * known_to);
  }
}

TEST_CASE("estimates are honest for every number of stages, and for other methods") {
  // Tolerances at both ends of the ranges of 8, 12 and 16 stages.
  const std::string name = GENERATE("fig2a", "fig2b", "spin");
  const Scenario scene = scenario_named(name);
  const model::Model model = model::assemble(scene, false);
  const solve::OutputGrid grid(scene.time);
  const Positions truth = exact_positions(model, grid);
  for (const Method method : {Method::radau, Method::bdf, Method::adams}) {
    for (const double bound : {5e-4, 3e-5, 4e-6, 2e-6, 3e-7, 3e-8, 4e-9, 2e-9}) {
      if (method != Method::radau && bound < 1e-7) continue;
      CAPTURE(name, int(method), bound);
      const Asked asked = ask(model, grid, truth, bound, method);
      CHECK(asked.result.met);
      CHECK(asked.error <= bound);
      CHECK(asked.result.estimate >= (asked.error - 4e-16 * asked.extent) / 3);
    }
  }
}

TEST_CASE("runs with different endings are far apart") {
  // A ball that stops exactly at the edge, or a tolerance beyond it.
  const Scenario scene = read_scenario(BBSIM_SOURCE_DIR "/configs/falls.yaml");
  const model::Model model = model::assemble(scene, false);
  const solve::OutputGrid grid(scene.time);
  const Asked asked = ask(model, grid, exact_positions(model, grid), 1e-9);
  REQUIRE(asked.result.outcome.ending == solve::Ending::stopped);
  // The time of leaving the plate is as accurate as the position.
  const auto fine = run_in_memory(scene, Method::radau, {1e-13, 1e-15});
  const double speed = std::hypot(asked.result.outcome.occurrences.back().sample.ball.x_dot,
                                  asked.result.outcome.occurrences.back().sample.ball.y_dot);
  CHECK(std::abs(asked.result.outcome.reached - fine.outcome.reached) * speed <= 1e-9);
}

TEST_CASE("an error bound is met in any scene, and its estimate is honest") {
  const std::string name = GENERATE("fig2a", "fast", "fig2b", "small-ball", "spin", "stiff-servo",
                                    "tumble", "losses", "torque-open", "torque-loop");
  const Scenario scene = scenario_named(name);
  const model::Model model = model::assemble(scene, false);
  const solve::OutputGrid grid(scene.time);
  const Positions truth = from_table(name);
  for (const double bound : {1e-4, 1e-6, 1e-8, 1e-10}) {
    const Asked asked = ask(model, grid, truth, bound);
    CAPTURE(name, bound, asked.result.estimate, asked.error, asked.result.tolerances.rtol);
    REQUIRE(asked.result.outcome.ending == solve::Ending::done);
    CHECK(asked.result.met);
    CHECK(asked.result.estimate <= bound);
    CHECK(asked.error <= bound);
    // Never below a third of the true error, beyond the rounding of the reference.
    const double rounding = 4e-16 * asked.extent;
    CHECK(asked.result.estimate >= (asked.error - rounding) / 3);
    // Nor far above it, unless both are rounding errors.
    CHECK(asked.result.estimate <= 30 * asked.error + 10 * rounding);
  }
}

TEST_CASE("an error bound beyond double precision is refused with the attainable one") {
  // Rounding of 1e-16 grows with the solution of `fast`, to 1263 m, so 1e-14 m is unattainable.
  const Scenario scene = scenario_named("fast");
  const model::Model model = model::assemble(scene, false);
  const Asked asked = ask(model, solve::OutputGrid(scene.time), from_table("fast"), 1e-14);
  CHECK(asked.result.outcome.ending == solve::Ending::done);
  CHECK_FALSE(asked.result.met);
  CHECK(asked.result.estimate > 1e-14);
  CHECK(asked.result.estimate < 1e-8);
  CHECK(asked.result.estimate >= asked.error / 3);
}

TEST_CASE("a scene that ends early does so for any error bound") {
  const Scenario scene = scenario_named("fig2b-literal");
  const model::Model model = model::assemble(scene, false);
  const solve::OutputGrid grid(scene.time);
  solve::Trajectory rows(model.size());
  const auto result = study::integrate_to_error(model, Method::automatic, 1e-6, grid, rows);
  CHECK(result.outcome.ending == solve::Ending::failed);
  CHECK_FALSE(result.met);
  CHECK(rows.rows() >= 75);
}

TEST_CASE("each row has an estimate, and the greatest is that of the run") {
  const Scenario scene = scenario_named("fig2b");
  const model::Model model = model::assemble(scene, false);
  const solve::OutputGrid grid(scene.time);
  solve::Trajectory rows(model.size());
  const auto result = study::integrate_to_error(model, Method::automatic, 1e-6, grid, rows);
  REQUIRE(result.met);
  REQUIRE(result.row_estimates.size() == rows.rows());
  double greatest = 0;
  for (const double estimate : result.row_estimates) {
    CHECK(estimate > 0);
    greatest = std::max(greatest, estimate);
  }
  CHECK(greatest == result.estimate);
  // At the start, where both runs begin, only rounding differs.
  CHECK(result.row_estimates.front() < 1e-3 * result.estimate);
}

}  // namespace bbsim_test::test_error_control
