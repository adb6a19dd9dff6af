// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Every integrator against the quad-precision solutions of all scenarios that have one.
#include <algorithm>
#include <cmath>
#include <string>

#include "catch.hpp"
#include "support/largest.hpp"
#include "support/run_in_memory.hpp"

namespace bbsim_test::test_against_reference {

using namespace bbsim;

namespace {

struct Errors {
  double position = 0;  // m, of x and y, at the worst output time
  double spin = 0;      // relative to the largest spin of the run
  double gamma = 0;     // relative to the largest gamma of the run
};

Errors errors_against(const std::string& name, const Run& run) {
  const QuadReference reference(name);
  REQUIRE(run.samples.size() == reference["t"].size());
  Errors errors;
  double largest_spin = 0, largest_gamma = 0;
  for (std::size_t i = 0; i < run.samples.size(); ++i) {
    const model::Sample& sample = run.samples[i];
    REQUIRE(std::abs(sample.t - reference["t"][i]) < 1e-12);
    errors.position = largest_finite(
        errors.position,
        {std::abs(sample.ball.x - reference["x"][i]), std::abs(sample.ball.y - reference["y"][i])});
    errors.spin =
        largest_finite(errors.spin, {std::abs(sample.ball.gamma_dot - reference["spin"][i])});
    errors.gamma = largest_finite(errors.gamma, {std::abs(sample.gamma - reference["gamma"][i])});
    largest_spin = std::max(largest_spin, std::abs(reference["spin"][i]));
    largest_gamma = std::max(largest_gamma, std::abs(reference["gamma"][i]));
  }
  errors.spin /= largest_spin;
  errors.gamma /= largest_gamma;
  return errors;
}

double farthest(const Run& run) {
  double distance = 0;
  for (const model::Sample& sample : run.samples) {
    distance = std::max({distance, std::abs(sample.ball.x), std::abs(sample.ball.y)});
  }
  return distance;
}

}  // namespace

TEST_CASE("with rtol 1e-10 every scenario is within its bound, and the error follows rtol") {
  struct Case {
    const char* name;
    double position_bound;  // m
  };
  // A tolerance of 1e-10 leaves about 1e-8 m on scenes within a meter. `fast` and `tumble` grow
  // exponentially, to 1263 m and 2948 m, and so do their errors.
  const auto [name, position_bound] = GENERATE(
      Case{"fig2a", 1e-7}, Case{"fig2b", 1e-7}, Case{"small-ball", 1e-7}, Case{"spin", 1e-7},
      Case{"stiff-servo", 1e-7}, Case{"fast", 1e-4}, Case{"tumble", 1e-5});
  const Method method = GENERATE(Method::automatic, Method::radau, Method::bdf, Method::adams);
  CAPTURE(name, static_cast<int>(method));
  // Adams takes 500,000 steps for the stiff servo; nobody would choose it.
  if (std::string(name) == "stiff-servo" && method == Method::adams) return;

  const Scenario scene = scenario_named(name);
  const Run tight_run = run_in_memory(scene, method, {1e-10, 1e-12});
  const Errors tight = errors_against(name, tight_run);
  const Errors loose = errors_against(name, run_in_memory(scene, method, {1e-5, 1e-7}));
  // BDF and Adams may leave a relative error of rtol in each step. The largest position contains
  // the sum of all of them, because it and its error grow alike.
  const double of_all_steps =
      1e-10 * static_cast<double>(tight_run.outcome.statistics.steps) * farthest(tight_run);
  const bool multistep = method == Method::bdf || method == Method::adams;
  CHECK(tight.position < (multistep ? std::max(position_bound, of_all_steps) : position_bound));
  CHECK(tight.spin < 1e-6);
  CHECK(tight.gamma < 1e-6);
  // Five decades of tolerance. If stability limits the steps, a loose tolerance is met with decades
  // to spare; at least two remain.
  CHECK(tight.position < 1e-2 * loose.position);
}

TEST_CASE("the printed law follows the exact solution until it blows up") {
  const Method method = GENERATE(Method::automatic, Method::radau, Method::bdf, Method::adams);
  CAPTURE(static_cast<int>(method));
  const Run run = run_in_memory(scenario_named("fig2b-literal"), method, {1e-10, 1e-12});
  CHECK(run.outcome.ending == solve::Ending::failed);
  CHECK_FALSE(run.outcome.reason.empty());
  CHECK(run.outcome.reached > 0.748);  // the singularity is near 0.7488 s
  CHECK(run.outcome.reached < 0.749);
  REQUIRE(run.samples.size() >= 75);               // up to t = 0.74 s
  const QuadReference reference("fig2b-literal");  // up to t = 0.6 s
  for (std::size_t i = 0; i < reference["t"].size(); ++i) {
    // The deviation grows like the solution: 1e5 times from the start to 0.6 s.
    CHECK(std::abs(run.samples[i].ball.x - reference["x"][i]) < 1e-5);
    CHECK(std::abs(run.samples[i].ball.y - reference["y"][i]) < 1e-5);
  }
}

}  // namespace bbsim_test::test_against_reference
