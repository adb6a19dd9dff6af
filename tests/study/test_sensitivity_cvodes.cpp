// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Derivatives with respect to keys, compared with CVODES, which integrates the states and their
// derivatives together with its Adams methods.
#include <algorithm>
#include <cmath>
#include <string>
#include <variant>
#include <vector>

#include "api/run.hpp"
#include "base/number_text.hpp"
#include "catch.hpp"
#include "model/model.hpp"
#include "scenario/reader.hpp"
#include "solve/cvode/sundials.hpp"
#include "support/run_in_memory.hpp"

using namespace bbsim;
namespace cv = solve::sundials;

namespace {

using Overrides = std::vector<std::string>;

// A scene, and the same scene with a key at nearby values.
struct Scene {
  model::Model model, above, below;
  double change;

  // Writes ds/dt = df/dz s + df/dp, both with central differences.
  void slope_rates(double t, const double* z, const double* s, double* into) const {
    const std::size_t n = model.size();
    std::vector<double> up(n), down(n), plus(n), minus(n);
    // Small compared with 1, the scale of the smooth states, for any size of s.
    double size = 1;
    for (std::size_t i = 0; i < n; ++i) size = std::max(size, std::abs(s[i]));
    const double share = 1e-5 / size;
    for (std::size_t i = 0; i < n; ++i) {
      up[i] = z[i] + share * s[i];
      down[i] = z[i] - share * s[i];
    }
    const auto rates = [t](const model::Model& of, const double* at, double* found) {
      std::visit([&](const auto& system) { system.derivative(t, at, found); }, of.system);
    };
    rates(model, up.data(), plus.data());
    rates(model, down.data(), minus.data());
    for (std::size_t i = 0; i < n; ++i) into[i] = (plus[i] - minus[i]) / (2 * share);
    rates(above, z, plus.data());
    rates(below, z, minus.data());
    for (std::size_t i = 0; i < n; ++i) into[i] += (plus[i] - minus[i]) / (2 * change);
  }
};

int rates(double t, N_Vector z, N_Vector into, void* data) {
  const auto& scene = *static_cast<const Scene*>(data);
  std::visit(
      [&](const auto& system) {
        system.derivative(t, N_VGetArrayPointer(z), N_VGetArrayPointer(into));
      },
      scene.model.system);
  return 0;
}

int slope_rates(int /*keys*/, double t, N_Vector z, N_Vector /*rates*/, int /*key*/, N_Vector s,
                N_Vector into, void* data, N_Vector /*room*/, N_Vector /*room*/) {
  static_cast<const Scene*>(data)->slope_rates(t, N_VGetArrayPointer(z), N_VGetArrayPointer(s),
                                               N_VGetArrayPointer(into));
  return 0;
}

// The derivatives of the states at the end of a scene.
std::vector<double> by_cvodes(Scene& scene, double end) {
  const cv::Context context = cv::make_context();
  const auto n = static_cast<sunindextype>(scene.model.size());
  const cv::Vector z(N_VNew_Serial(n, context.get()));
  const cv::Vector s(N_VNew_Serial(n, context.get()));
  std::ranges::copy(scene.model.initial, N_VGetArrayPointer(z.get()));
  for (std::size_t i = 0; i < scene.model.size(); ++i) {
    N_VGetArrayPointer(s.get())[i] =
        (scene.above.initial[i] - scene.below.initial[i]) / (2 * scene.change);
  }
  const cv::CvodeMemory memory(CVodeCreate(CV_ADAMS, context.get()));
  void* const solver = memory.get();
  const cv::NonlinearSolver for_z(SUNNonlinSol_FixedPoint(z.get(), 0, context.get()));
  const cv::NonlinearSolver for_s(SUNNonlinSol_FixedPoint(s.get(), 0, context.get()));
  constexpr double rtol = 1e-12, atol = 1e-14;
  constexpr long most_steps = 1000000;
  double slope_atol = 1e-12;
  N_Vector slopes[1] = {s.get()};
  REQUIRE(CVodeInit(solver, rates, 0, z.get()) == CV_SUCCESS);
  REQUIRE(CVodeSStolerances(solver, rtol, atol) == CV_SUCCESS);
  REQUIRE(CVodeSetUserData(solver, &scene) == CV_SUCCESS);
  REQUIRE(CVodeSetMaxNumSteps(solver, most_steps) == CV_SUCCESS);
  REQUIRE(CVodeSetNonlinearSolver(solver, for_z.get()) == CV_SUCCESS);
  REQUIRE(CVodeSensInit1(solver, 1, CV_STAGGERED1, slope_rates, slopes) == CV_SUCCESS);
  REQUIRE(CVodeSensSStolerances(solver, rtol, &slope_atol) == CV_SUCCESS);
  REQUIRE(CVodeSetSensErrCon(solver, 1) == CV_SUCCESS);
  REQUIRE(CVodeSetNonlinearSolverSensStg1(solver, for_s.get()) == CV_SUCCESS);
  REQUIRE(CVodeSetStopTime(solver, end) == CV_SUCCESS);
  double reached = 0;
  REQUIRE(CVode(solver, end, z.get(), &reached, CV_NORMAL) >= 0);
  REQUIRE(CVodeGetSens(solver, &reached, slopes) == CV_SUCCESS);
  return {N_VGetArrayPointer(s.get()), N_VGetArrayPointer(s.get()) + n};
}

}  // namespace

TEST_CASE("derivatives agree with those of CVODES", "[sensitivity]") {
  struct Case {
    std::string scene, key;
    double value;
  };
  for (const Case& one : {Case{"fig2a", "gravity", 9.81}, Case{"fig2b", "ball.radius", 0.01},
                          Case{"fig2b", "controller.pd.kv.0.0", 1},
                          Case{"fig2b", "gimbal.servo.natural_frequency", 10},
                          Case{"fast", "ball.radius", 0.01}, Case{"spin", "ball.spin", 30}}) {
    CAPTURE(one.scene, one.key);
    const std::string file = bbsim_test::data_file("scenarios/" + one.scene + ".yaml");
    const auto at = [&](double value) {
      return read_scenario(
          file, {one.key + "=" + number_text(value), "solver.rtol=1e-13", "solver.atol=1e-15"});
    };
    const Scenario scenario = at(one.value);
    const auto assembled = [](const Scenario& of) {
      return model::assemble(of, false, model::Form::full);
    };
    const double change = std::exp2(std::floor(std::log2(one.value)) - 17);
    Scene scene{assembled(scenario), assembled(at(one.value + change)),
                assembled(at(one.value - change)), change};
    const std::vector<double> expected = by_cvodes(scene, scenario.time.end);
    api::RunRequest request{scenario};
    request.sensitivity = {one.key};
    api::Watch watch;
    const api::RunResult made = api::run(request, watch);
    const std::vector<std::string> states = scene.model.state_names();
    double largest = 0;
    for (const double of : expected) largest = std::max(largest, std::abs(of));
    CHECK(largest > 0);
    std::size_t compared = 0;
    for (std::size_t i = 0; i < states.size(); ++i) {
      const auto found =
          std::ranges::find(made.rows.names, "d(" + states[i] + ")/d(" + one.key + ")");
      if (found == made.rows.names.end()) continue;
      const auto index = static_cast<std::size_t>(found - made.rows.names.begin());
      CAPTURE(states[i], expected[i]);
      // CVODES' error over the run, from its tolerance.
      CHECK(made.rows.columns[index].back() == Approx(expected[i]).margin(1e-7 * largest));
      ++compared;
    }
    CHECK(compared > 0);
  }
}
