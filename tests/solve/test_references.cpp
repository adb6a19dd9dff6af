// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Every integrator against the quad-precision solutions of all scenarios that have one.
#include <algorithm>
#include <cmath>
#include <string>

#include "catch.hpp"
#include "solve/radau/radau.hpp"
#include "support/energy_balance.hpp"
#include "support/largest.hpp"
#include "support/run_in_memory.hpp"

namespace bbsim_test::test_references {

using namespace bbsim;

namespace {

struct Compared {
  const char* column;
  double (*value)(const model::Sample&);
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

// Largest difference of a column, relative to its largest value.
double worst_column(const QuadReference& reference, const Run& run) {
  REQUIRE(run.samples.size() == reference["t"].size());
  double worst = 0;
  for (const Compared& of : compared) {
    const std::vector<double>& expected = reference[of.column];
    double size = 1e-12, difference = 0;  // some columns are zero
    for (std::size_t i = 0; i < expected.size(); ++i) {
      size = std::max(size, std::abs(expected[i]));
      difference = largest_finite(difference, {std::abs(of.value(run.samples[i]) - expected[i])});
    }
    worst = std::max(worst, difference / size);
  }
  return worst;
}

// Of x and y, m.
double place_error(const QuadReference& reference, const Run& run) {
  REQUIRE(run.samples.size() == reference["t"].size());
  double error = 0;
  for (std::size_t i = 0; i < run.samples.size(); ++i) {
    error = largest_finite(error, {std::abs(run.samples[i].ball.x - reference["x"][i]),
                                   std::abs(run.samples[i].ball.y - reference["y"][i])});
  }
  return error;
}

struct Known {
  const char* name;
  double bound;      // of any column, relative; a tenth of it for collocation
  double amplifies;  // a local error over the run; fast and tumble grow exponentially
};
const Known scenes[] = {{"fig2a", 1e-7, 10},       {"fig2b", 1e-7, 10},
                        {"small-ball", 1e-7, 10},  {"spin", 1e-7, 10},
                        {"stiff-servo", 1e-6, 10}, {"fast", 5e-8, 1e4},
                        {"tumble", 3e-8, 1e4},     {"losses", 1e-9, 10},
                        {"torque-open", 1e-9, 10}, {"torque-loop", 1e-9, 10}};

}  // namespace

TEST_CASE("every integrator follows the quad-precision solutions in every column") {
  const Method method = GENERATE(Method::automatic, Method::radau, Method::bdf, Method::adams);
  for (const Known& of : scenes) {
    // Adams takes 500,000 steps for the stiff servo.
    if (method == Method::adams && of.name == std::string("stiff-servo")) continue;
    CAPTURE(of.name, static_cast<int>(method));
    const Scenario scene = scenario_named(of.name);
    const QuadReference reference(of.name);
    const Run tight = run_in_memory(scene, method, {1e-10, 1e-12});
    CHECK(tight.outcome.ending == solve::Ending::done);
    const bool multistep = method == Method::bdf || method == Method::adams;
    CHECK(worst_column(reference, tight) < (multistep ? of.bound : of.bound / 10));
    if (tight.samples[0].coupled) CHECK(energy_gap(scene, tight) < 1e-9);
    // Five decades of tolerance. If stability limits the steps, a loose tolerance is met with
    // decades to spare; at least two remain.
    const Run loose = run_in_memory(scene, method, {1e-5, 1e-7});
    CHECK(place_error(reference, tight) < 1e-2 * place_error(reference, loose));
  }
}

TEST_CASE("collocation follows the quad-precision solutions with any number of stages") {
  const int stages = GENERATE(8, 12, 16);
  for (const Known& of : scenes) {
    const Scenario scene = scenario_named(of.name);
    const model::Model model = model::assemble(scene, true);
    if (model.hybrid()) continue;
    const QuadReference reference(of.name);
    const solve::OutputGrid grid(scene.time);
    double turned = 0;
    for (const double angle : reference["gamma"]) turned = std::max(turned, std::abs(angle));
    for (const double rtol : {1e-5, 1e-8, 1e-11}) {
      CAPTURE(of.name, stages, rtol);
      solve::radau::RadauStepper stepper(model, solve::radau::choose_kernels(), stages,
                                         {rtol, rtol / 100}, scene.time.end);
      solve::Trajectory rows(model.row_size());
      Run run{run_through(stepper, model, grid, rows, {}), {}};
      REQUIRE(run.outcome.ending == solve::Ending::done);
      for (std::size_t i = 0; i < rows.rows(); ++i) {
        run.samples.push_back(model.sample(grid[i], rows.row(i)));
      }
      CHECK(place_error(reference, run) < of.amplifies * rtol);
      const double radius = scene.ball.radius;
      double spun = 0;
      for (std::size_t i = 0; i < rows.rows(); ++i) {
        spun =
            largest_finite(spun, {radius * std::abs(run.samples[i].gamma - reference["gamma"][i])});
      }
      CHECK(spun < of.amplifies * rtol * (1 + radius * turned));
    }
  }
}

}  // namespace bbsim_test::test_references
