// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Sampled rigs of configs/hard against CVODE, which integrates their servos as states.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "scenario/columns.hpp"
#include "solve/hard_cases.hpp"
#include "study/accuracy.hpp"

namespace bbsim_test::test_hard_rigs {

using namespace bbsim;

TEST_CASE("hard rigs keep the errors that the documents state") {
  struct Case {
    const char* name;
    double error;  // m, as in docs/explanation/hard-cases.md
  };
  const auto [name, error] =
      GENERATE(Case{"edge-of-reach", 1e-10}, Case{"dead-point", 1e-10}, Case{"jitter", 1e-12},
               Case{"backlash", 1e-11}, Case{"fast-servo", 1e-12});
  CAPTURE(name);
  const Scenario scene = hard_case(name);
  const auto model = model::assemble(
      scene, scenario::integrals_for(scenario::columns_named(scene.output.columns)));
  const study::AccuracyStudy study = study::measure_accuracy(model, solve::OutputGrid(scene.time),
                                                             {Method::radau}, {scene.solver.rtol});
  const study::AccuracyPoint& point = study.points.front();
  CHECK(study.reference_by_cvode);
  CHECK(study.reference_error < error);
  CHECK(point.error < error);
  const bool is_thrown_off = name == std::string("fast-servo");
  CHECK(study.reference_complete != is_thrown_off);
  CHECK(point.ending == (is_thrown_off ? solve::Ending::stopped : solve::Ending::done));
}

TEST_CASE("after a million samples, a rig follows its circle as in the first minutes") {
  const Scenario scene = hard_case("long-run");
  const Run run = whole_run(scene, Method::automatic, {1e-8, 1e-10}, false);
  double early = 0, late = 0;  // the largest distance from the reference, at fifty places of it
  for (std::size_t i = 1; i < run.samples.size(); ++i) {
    const model::Sample& sample = run.samples[i];
    double& half = i <= 50 ? early : late;
    half = std::max(
        half, std::hypot(sample.ball.x - sample.reference[0], sample.ball.y - sample.reference[1]));
  }
  // Fifty places of the circle miss the worst one by some 4 degrees, and its distance by 0.2 %.
  CHECK(late == Approx(early).epsilon(0.001));
}

}  // namespace bbsim_test::test_hard_rigs
