// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Losses and torques against quad-precision solutions, with every integrator.
#include <algorithm>
#include <cmath>
#include <string>

#include "catch.hpp"
#include "support/energy_balance.hpp"
#include "support/largest.hpp"
#include "support/run_in_memory.hpp"

namespace bbsim_test::test_coupled_references {

using namespace bbsim;

namespace {

using Value = double (*)(const model::Sample&);
struct Compared {
  const char* column;
  Value value;
};
constexpr Compared compared[] = {
    {"x", [](const model::Sample& s) { return s.ball.x; }},
    {"y", [](const model::Sample& s) { return s.ball.y; }},
    {"vx", [](const model::Sample& s) { return s.ball.x_dot; }},
    {"vy", [](const model::Sample& s) { return s.ball.y_dot; }},
    {"spin", [](const model::Sample& s) { return s.ball.gamma_dot; }},
    {"gamma", [](const model::Sample& s) { return s.gamma; }},
    {"phi", [](const model::Sample& s) { return s.gimbal.phi; }},
    {"theta", [](const model::Sample& s) { return s.gimbal.theta; }},
    {"phi_rate", [](const model::Sample& s) { return s.gimbal.phi_dot; }},
    {"theta_rate", [](const model::Sample& s) { return s.gimbal.theta_dot; }},
};

// Worst difference of a column, relative to its largest value.
double worst_difference(const std::string& name, const Run& run) {
  const QuadReference reference(name);
  REQUIRE(run.samples.size() == reference["t"].size());
  double worst = 0;
  for (const Compared& of : compared) {
    const std::vector<double>& expected = reference[of.column];
    double size = 0, difference = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      size = std::max(size, std::abs(expected[i]));
      difference = largest_finite(difference, {std::abs(of.value(run.samples[i]) - expected[i])});
    }
    INFO(of.column << ": " << difference / size);
    CHECK(difference < 1e-9 * size);
    worst = std::max(worst, difference / size);
  }
  return worst;
}

}  // namespace

TEST_CASE("losses and torques are within 1e-9 of quad-precision solutions") {
  const std::string name = GENERATE("losses", "torque-open", "torque-loop");
  const Method method = GENERATE(Method::radau, Method::bdf, Method::adams);
  CAPTURE(name, static_cast<int>(method));
  const Run run = run_in_memory(scenario_named(name), method, {1e-10, 1e-12});
  CHECK(run.outcome.ending == solve::Ending::done);
  static_cast<void>(worst_difference(name, run));
  CHECK(energy_gap(scenario_named(name), run) < 1e-9);
}

}  // namespace bbsim_test::test_coupled_references
