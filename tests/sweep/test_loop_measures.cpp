// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Measures of the loop in sweeps: stability maps, and margins together with measures of motion.
#include <cmath>
#include <string>
#include <vector>

#include "catch.hpp"
#include "model/control/loop_analysis.hpp"
#include "support/sweep_setup.hpp"
#include "sweep/sweep.hpp"
#include "sweep/task.hpp"

namespace bbsim_test::test_loop_measures {

using namespace bbsim;
using namespace bbsim::sweep;

namespace {

Setup setup_of(const std::string& scene, std::vector<Variation> vary,
               const std::vector<std::string>& names, const std::vector<std::string>& set = {}) {
  return {"configs/" + scene + ".yaml", std::move(vary), set, names};
}

// Results as delivered by `threads` threads.
CaseResults run(const SweepTask& task, std::size_t threads = 2) {
  CaseResults all;
  const bool finished = run_sweep(
      choose_engine(task), {0, task.plan.cases()}, threads, goes_on, [](CaseResults&) {},
      [&](const CaseResults& some) {
        all.count += some.count;
        all.values.insert(all.values.end(), some.values.begin(), some.values.end());
        all.numbers.insert(all.numbers.end(), some.numbers.begin(), some.numbers.end());
        all.status.insert(all.status.end(), some.status.begin(), some.status.end());
      });
  REQUIRE(finished);
  REQUIRE(all.count == task.plan.cases());
  return all;
}

const std::string kp = "controller.gravity_compensation.kp";
const std::string kv = "controller.gravity_compensation.kv";

bool same(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

}  // namespace

TEST_CASE("the border of a stability map satisfies Routh-Hurwitz") {
  // A PD law with a second-order servo. Near home, x'' = 5/7 g phi - r phi'': gravity, and the
  // contact point under a turning plate. The loop's poles are then the zeros of
  //   s^4 + (2 zeta w - w^2 r kv) s^3 + w^2 (1 - r kp) s^2 + w^2 c kv s + w^2 c kp, c = 5/7 g.
  const Setup setup = setup_of("hold",
                               {{"controller.pd.kp.0.0,-controller.pd.kp.1.1", "linear:0.1:12:40"},
                                {"controller.pd.kv.0.0,-controller.pd.kv.1.1", "linear:0.05:6:40"}},
                               {"stable", "spectral_abscissa"});
  const Engine engine = choose_engine(setup.task);
  CHECK(engine.name == "linear analysis");
  const CaseResults results = run(setup.task);
  const Scenario first = setup.family.read({});
  const double w = first.gimbal.servo->natural_frequency, zeta = first.gimbal.servo->damping;
  const double r = first.ball.radius, c = 5.0 / 7 * first.gravity;
  int stable = 0;
  for (std::size_t i = 0; i < results.count; ++i) {
    const double p = results.values[4 * i], v = results.values[4 * i + 2];
    const double a3 = 2 * zeta * w - w * w * r * v, a2 = w * w * (1 - r * p), a1 = w * w * c * v,
                 a0 = w * w * c * p;
    const double hurwitz = a1 * (a3 * a2 - a1) - a3 * a3 * a0;
    const bool expected = a3 > 0 && a2 > 0 && hurwitz > 0;
    CAPTURE(p, v);
    // No case of the grid is within rounding of the border.
    REQUIRE(std::abs(hurwitz) > 1e-9 * std::abs(a1 * a3 * a2));
    CHECK(results.numbers[3 * i + 1] == (expected ? 1 : 0));
    CHECK((results.numbers[3 * i + 2] < 0) == expected);
    CHECK(std::isnan(results.numbers[3 * i]));  // no run took place
    CHECK(results.status[i].word == "done");
    CHECK(results.status[i].reason.empty());
    stable += expected ? 1 : 0;
  }
  CHECK(stable > 200);
  CHECK(stable < 1400);
}

TEST_CASE("margins added to measures of motion do not change these, and keep the lanes") {
  const std::vector<Variation> vary{{kp, "linear:2:40:6"}, {kv, "linear:2:14:6"}};
  const std::vector<std::string> set{"time.end=4"};
  const Setup both = setup_of(
      "rig", vary, {"phi_delay_margin", "rms_tracking_error", "stable", "max_tilt", "end_x"}, set);
  const Setup motion = setup_of("rig", vary, {"rms_tracking_error", "max_tilt", "end_x"}, set);
  CHECK(choose_engine(both.task).name == "rig lanes");
  CHECK(choose_engine(both.task).group == choose_engine(motion.task).group);
  const CaseResults a = run(both.task), b = run(motion.task);
  int stable = 0;
  for (std::size_t i = 0; i < a.count; ++i) {
    CAPTURE(i);
    const double* const mine = &a.numbers[6 * i];
    const double* const theirs = &b.numbers[4 * i];
    CHECK(mine[0] == theirs[0]);
    CHECK(same(mine[2], theirs[1]));
    CHECK(same(mine[4], theirs[2]));
    CHECK(same(mine[5], theirs[3]));
    CHECK(a.status[i].word == b.status[i].word);

    const Scenario scene = both.family.read(both.plan.settings(i));
    const model::Model model = model::assemble(scene, false);
    model::LoopAnalysis analysis(scene, model, model::parts_of(both.task.measures));
    CHECK(same(mine[1], analysis.value_of(*both.task.measures[0].loop).value));
    CHECK(mine[3] == analysis.value_of(*both.task.measures[2].loop).value);
    CHECK(std::isnan(mine[1]) == (mine[3] == 0));
    if (mine[3] == 0 && a.status[i].word == "done") {
      CHECK(a.status[i].reason == "phi_delay_margin is not a number: the loop is not stable");
    }
    stable += mine[3] == 1 ? 1 : 0;
  }
  CHECK(stable > 5);
  CHECK(stable < 36);
}

TEST_CASE("any number of threads gives the same numbers") {
  const Setup setup = setup_of("rig", {{kp, "linear:2:40:9"}, {kv, "linear:2:14:9"}},
                               {"phi_phase_margin", "spectral_radius", "x_feedback_bandwidth"});
  const CaseResults one = run(setup.task, 1), three = run(setup.task, 3);
  REQUIRE(one.numbers.size() == three.numbers.size());
  for (std::size_t i = 0; i < one.numbers.size(); ++i)
    CHECK(same(one.numbers[i], three.numbers[i]));
}

TEST_CASE("a measure of the loop is refused if no case has it, but not if some do") {
  const auto [scene, name, why] = GENERATE(table<std::string, std::string, std::string>({
      {"fig2a", "stable", "there is no controller"},
      {"fig2b", "spectral_radius", "the controller takes no samples"},
      {"sags", "phi_gain_margin", "dry friction has no linear equations"},
  }));
  const Setup none = setup_of(scene, {{"ball.radius", "list:0.01,0.02"}}, {"end_x"});
  CHECK_THROWS_WITH(sweep_measures({name}, none.family, none.plan),
                    "measure: found " + name + ", but " + why);

  const Setup some = setup_of("fig2b", {{"controller.sampling", "list:null,{period: 0.02}"}},
                              {"spectral_radius", "spectral_abscissa"});
  const CaseResults results = run(some.task);
  CHECK(std::isnan(results.numbers[1]));
  CHECK(results.status[0].reason ==
        "spectral_radius is not a number: the controller takes no samples");
  CHECK(results.numbers[4] > 0);
  CHECK(results.status[1].reason.empty());
}

}  // namespace bbsim_test::test_loop_measures
