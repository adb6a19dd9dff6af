// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The collocation integrator: against quad-precision solutions, and at its limits.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "catch.hpp"
#include "model/systems/list.hpp"
#include "solve/cvode/cvode.hpp"
#include "solve/integrate.hpp"
#include "solve/radau/radau.hpp"
#include "support/largest.hpp"
#include "support/run_in_memory.hpp"

namespace bbsim_test::test_radau {

using namespace bbsim;
using solve::radau::RadauStepper;
using solve::radau::StepKernels;

namespace {

struct Rows {
  solve::Outcome run;
  solve::Trajectory rows;
};

Rows integrate(const model::Model& model, const Scenario& scene, double rtol,
               const StepKernels& kernels = solve::radau::choose_kernels(), int stages = 0,
               const solve::Watch& watch = {}) {
  if (stages == 0) stages = solve::radau::choose_stages(model, rtol);
  RadauStepper stepper(model, kernels, stages, {rtol, rtol / 100}, scene.time.end);
  solve::Trajectory rows(model.row_size());
  const solve::Outcome run =
      run_through(stepper, model, solve::OutputGrid(scene.time), rows, watch);
  return {run, std::move(rows)};
}

// Memory for a kernel, aligned.
struct Workspace {
  explicit Workspace(std::size_t bytes) : memory(bytes / sizeof(double) + 8) {
    void* start = memory.data();
    std::size_t space = memory.size() * sizeof(double);
    place = std::align(64, bytes, start, space);
  }
  std::vector<double> memory;
  void* place = nullptr;
};

// Largest difference of all states in all rows, in units of rtol: relative to the largest value of
// each state, but at least to atol / rtol = 0.01.
double difference(const solve::Trajectory& a, const solve::Trajectory& b, std::size_t row_size) {
  REQUIRE(a.rows() == b.rows());
  double worst = 0;
  for (std::size_t column = 0; column < row_size; ++column) {
    double largest = 1e-2, apart = 0;
    for (std::size_t i = 0; i < a.rows(); ++i) {
      largest = largest_finite(largest, {std::abs(b.row(i)[column])});
      apart = largest_finite(apart, {std::abs(a.row(i)[column] - b.row(i)[column])});
    }
    worst = largest_finite(worst, {apart / largest});
  }
  return worst;
}

}  // namespace

TEST_CASE("a step's error has at least the order of its stages") {
  const Scenario scene = scenario_named("fast");
  const model::Model model = model::assemble(scene, false);
  // Steps of 0.8 and 0.4 s, 2 and 1 rad on either side of the sinusoid's middle. The order at the
  // end of an 8-stage step is 15; the bound is the 9 of its polynomial, in case the first step is
  // outside the asymptotic range.
  const auto error_of = [&](double h) {
    Scenario one = scene;
    one.time = {h, h};
    const auto& kernel = solve::radau::choose_kernels().kernels[0][model.system.index()];
    const Rows exact = integrate(model, one, 1e-13);
    const auto view = std::get<0>(model.system).view();
    const Workspace memory(kernel.workspace);
    void* const workspace = memory.place;
    kernel.start(workspace, {&view, model.initial.data(), 1e-12, 1e-14, false});
    solve::radau::Attempt attempt{};
    kernel.attempt(workspace, 0, h, &attempt);
    REQUIRE(attempt.verdict == solve::radau::Verdict::converged);
    kernel.accept(workspace);
    double z[5];
    kernel.state(workspace, z);
    return std::hypot(z[0] - exact.rows.row(1)[0], z[1] - exact.rows.row(1)[1]);
  };
  CHECK(std::log2(error_of(0.8) / error_of(0.4)) > 9);
}

TEST_CASE("a fast servo costs collocation no steps") {
  Scenario scene = scenario_named("stiff-servo");
  const double natural_frequency = GENERATE(2000.0, 20000.0);
  scene.gimbal.servo->natural_frequency = natural_frequency;
  // The loop is stable while r k_v omega_n^2 < 2 zeta omega_n (docs/explanation/rig-model.md,
  // (M13)).
  const double gain = 100 / natural_frequency;
  scene.controller->kv = {{{gain, 0}, {0, -gain}}};
  scene.controller->kp = scene.controller->kv;
  const model::Model model = model::assemble(scene, true);
  const Rows usual = integrate(model, scene, 1e-6);
  const Rows tight = integrate(model, scene, 1e-11);
  CHECK(usual.run.ending == solve::Ending::done);
  // Resolving the servo itself would take 21 s * 20000 / s = 420,000 time constants.
  CHECK(usual.run.statistics.steps < 100);
  CHECK(tight.run.statistics.steps < 500);
  // Ten local errors of 1e-6 m, for the ball only, because the servo's motion is not smooth.
  for (std::size_t i = 0; i < usual.rows.rows(); ++i) {
    CHECK(std::abs(usual.rows.row(i)[0] - tight.rows.row(i)[0]) < 1e-5);
    CHECK(std::abs(usual.rows.row(i)[1] - tight.rows.row(i)[1]) < 1e-5);
  }
}

TEST_CASE("the integrator does not step over a fast small sinusoid beside a slow one") {
  Scenario scene = scenario_named("fig2a");
  scene.gimbal.motion->phi.emplace_back(Sinusoid{1e-3, 300, 0, 0});
  const model::Model model = model::assemble(scene, false);
  const Rows loose = integrate(model, scene, 1e-5);
  const Rows tight = integrate(model, scene, 1e-11);
  // 10 s * 300 rad/s with fewer than two nodes per radian.
  CHECK(loose.run.statistics.steps * 8 > 1500);
  CHECK(difference(loose.rows, tight.rows, model.size()) < 1e-3);  // a hundred local errors
}

TEST_CASE("instruction sets agree to the tolerance") {
  const char* name = GENERATE("fig2a", "fig2b", "stiff-servo", "spin");
  const int stages = GENERATE(8, 12, 16);
  const Scenario scene = scenario_named(name);
  const model::Model model = model::assemble(scene, true);
  const Rows chosen = integrate(model, scene, 1e-9, solve::radau::choose_kernels(), stages);
  for (const char* const set : {"avx512", "avx2", "sse2", "baseline"}) {
    const auto found = simd::find_instruction_set(set);
    if (!found) continue;
    CAPTURE(name, stages, set);
    const StepKernels& kernels = simd::kernels_by<simd::Widest::avx2>(
        [](auto isa) -> const auto& { return solve::radau::kernels<decltype(isa)>(); }, *found);
    const Rows other = integrate(model, scene, 1e-9, kernels, stages);
    // Both are within ten local errors of the truth; with equal steps they are far closer.
    CHECK(difference(other.rows, chosen.rows, model.size() + (model.gamma ? 1 : 0)) < 2e-8);
  }
}

TEST_CASE("BBSIM_SIMD selects the kernels, or is refused") {
  setenv("BBSIM_SIMD", "abacus", 1);
  CHECK_THROWS_WITH(solve::radau::choose_kernels(), Catch::Contains("BBSIM_SIMD") &&
                                                        Catch::Contains("'abacus'") &&
                                                        Catch::Contains("allowed"));
#ifdef __x86_64__
  setenv("BBSIM_SIMD", "sse2", 1);
  CHECK(std::string(simd::name_of(simd::chosen_instruction_set())) == "sse2");
#endif
  unsetenv("BBSIM_SIMD");
}

TEST_CASE("the first step's rate is the norm of the exact Jacobian") {
  const Scenario scene = scenario_named("fig2b");
  const model::Model model = model::assemble(scene, false);
  Scenario still = scene;
  still.time = {1e-3, 1e-3};
  std::visit(
      [&](const auto& system) {
        using System = std::decay_t<decltype(system)>;
        Eigen::Matrix<double, System::size, System::size> matrix;
        model::jacobian(model.system, 0.0, model.initial.data(), matrix.data());
        double of_velocities = 0, of_positions = 0;
        for (const auto& row : System::motions.of) {
          double v = 0, q = 0;
          for (const auto& column : System::motions.of) {
            v += std::abs(matrix(row.velocity, column.velocity));
            if (column.position >= 0) q += std::abs(matrix(row.velocity, column.position));
          }
          of_velocities = std::max(of_velocities, v);
          of_positions = std::max(of_positions, q);
        }
        const auto view = system.view();
        const auto& kernel = solve::radau::choose_kernels().kernels[0][model.system.index()];
        const Workspace memory(kernel.workspace);
        void* const workspace = memory.place;
        kernel.start(workspace, {&view, model.initial.data(), 1e-8, 1e-10, false});
        // The same sum in another order.
        CHECK(kernel.rate(workspace, 0) ==
              Approx(std::max(of_velocities, std::sqrt(of_positions))).epsilon(1e-14));
      },
      model.system);
}

}  // namespace bbsim_test::test_radau
