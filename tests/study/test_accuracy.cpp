// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The cost of accuracy: errors against an independent reference, and the choice of the best point.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "catch.hpp"
#include "reference_table.hpp"
#include "scenario/reader.hpp"
#include "solve/integrate.hpp"
#include "study/accuracy.hpp"

namespace bbsim_test::test_accuracy {

using bbsim::Method;
using bbsim::study::AccuracyPoint;
using bbsim::study::AccuracyStudy;

namespace {

bbsim::Scenario scene(const std::string& name) {
  return bbsim::read_scenario(BBSIM_SOURCE_DIR "/tests/data/scenarios/" + name + ".yaml");
}

AccuracyPoint point(Method method, double rtol, double error, double seconds) {
  AccuracyPoint made;
  made.method = method;
  made.tolerances = {rtol, bbsim::study::ten_digits(rtol / 100)};
  made.error = error;
  made.cpu_seconds = seconds;
  made.statistics = {12, 34, 5, 0, 0};
  return made;
}

}  // namespace

TEST_CASE("measured errors agree with an independent reference") {
  const bbsim::Scenario scenario = scene("fig2a");
  const auto model = bbsim::model::assemble(scenario, true);
  const bbsim::solve::OutputGrid grid(scenario.time);
  const std::vector<Method> methods{Method::bdf, Method::adams};
  const std::vector<double> rtols{1e-4, 1e-8};
  std::vector<double> progress;
  const AccuracyStudy study = bbsim::study::measure_accuracy(
      model, grid, methods, rtols, {nullptr, [&](double part) { progress.push_back(part); }});

  REQUIRE(study.points.size() == 4);
  CHECK(study.reference_complete);
  CHECK(study.reference_error < 1e-20);  // the reference's accuracy for well-behaved scenes
  CHECK_FALSE(study.interrupted);
  CHECK(std::is_sorted(progress.begin(), progress.end()));
  CHECK(progress.back() == Approx(1));

  const auto table = read_reference_table("fig2a");
  for (std::size_t i = 0; i < 4; ++i) {
    const AccuracyPoint& measured = study.points[i];
    CAPTURE(i);
    CHECK(measured.method == methods[i / 2]);
    CHECK(measured.tolerances.rtol == rtols[i % 2]);
    CHECK(measured.tolerances.atol == (i % 2 == 0 ? 1e-6 : 1e-10));
    CHECK(measured.ending == bbsim::solve::Ending::done);
    CHECK(measured.repeats >= 5);
    CHECK(measured.cpu_seconds > 0);

    bbsim::solve::Trajectory rows(model.size() + 1);
    const auto outcome =
        bbsim::solve::integrate(model, measured.method, measured.tolerances, grid, rows);
    CHECK(measured.statistics.steps == outcome.statistics.steps);
    double error = 0;
    for (std::size_t row = 0; row < table.size(); ++row) {
      for (std::size_t c = 0; c < 2; ++c) {
        error = std::max(error, std::abs(plain(rows.row(row)[c] - table[row][1 + c])));
      }
    }
    // The table uses exactly 0.01 m and 0.3, the model the nearest doubles. In this scene the
    // effect is less than 1e-15 m (test_reference.cpp).
    CHECK(measured.error == Approx(error).margin(1e-15));
  }
  CHECK(study.points[1].error < study.points[0].error);
  CHECK(study.points[3].error < study.points[2].error);
}

TEST_CASE("runs that end early are marked, and compared as far as the reference goes") {
  bbsim::Scenario scenario = scene("fig2b-literal");
  const auto model = bbsim::model::assemble(scenario, false);
  const bbsim::solve::OutputGrid grid(scenario.time);
  const AccuracyStudy study = bbsim::study::measure_accuracy(model, grid, {Method::bdf}, {1e-6});
  REQUIRE(study.points.size() == 1);
  CHECK(study.points[0].ending == bbsim::solve::Ending::failed);
  CHECK_FALSE(study.reference_complete);
  CHECK(study.reference_reached == Approx(0.7488).epsilon(1e-4));  // time of the singularity
  CHECK_FALSE(study.reference_reason.empty());
  CHECK(best_by_decade(study).empty());
  CHECK(accuracy_csv(study).find(",failed\n") != std::string::npos);
}

TEST_CASE("a study can be interrupted") {
  const bbsim::Scenario scenario = scene("fig2a");
  const auto model = bbsim::model::assemble(scenario, false);
  const bbsim::solve::OutputGrid grid(scenario.time);
  std::atomic<bool> stop = false;
  // After the reference, which takes the first twentieth of the progress, and the first point.
  const AccuracyStudy study =
      bbsim::study::measure_accuracy(model, grid, {Method::adams}, {1e-3, 1e-4, 1e-5},
                                     {&stop, [&](double part) { stop = part > 0.06; }});
  CHECK(study.interrupted);
  CHECK(study.points.size() == 1);
}

TEST_CASE("the best choice of a decade is the fastest accurate one") {
  AccuracyStudy study;
  study.points = {point(Method::bdf, 1e-4, 3e-4, 1e-4), point(Method::bdf, 1e-6, 2e-6, 2e-4),
                  point(Method::adams, 1e-4, 1e-5, 3e-4), point(Method::adams, 1e-6, 5e-7, 1.5e-4),
                  point(Method::adams, 1e-9, 0, 9e-4)};
  AccuracyPoint failed = point(Method::radau, 1e-8, 1e-9, 1e-6);
  failed.ending = bbsim::solve::Ending::failed;
  study.points.push_back(failed);

  const auto best = best_by_decade(study);
  REQUIRE(best.size() == 14);  // 1e-3 down to 1e-16, which stands for zero
  CHECK(best[0].error == Approx(1e-3));
  CHECK(best[0].point == &study.points[0]);
  CHECK(best[1].error == Approx(1e-4));
  CHECK(best[1].point == &study.points[3]);  // more accurate than requested, and faster
  CHECK(best[3].error == Approx(1e-6));
  CHECK(best[3].point == &study.points[3]);
  CHECK(best[4].error == Approx(1e-7));
  CHECK(best[4].point == &study.points[4]);
  CHECK(best.back().point == &study.points[4]);

  study.points.assign(1, failed);
  CHECK(best_by_decade(study).empty());
}

TEST_CASE("the CSV of a study has its columns by name") {
  AccuracyStudy study;
  study.points = {point(Method::bdf, 1e-5, 2.5e-7, 1.25e-4)};
  study.points.push_back(point(Method::adams, 0.001, std::numeric_limits<double>::infinity(), 1));
  study.points.back().ending = bbsim::solve::Ending::failed;
  CHECK(accuracy_csv(study) ==
        "method,rtol,atol,error_m,time_us,steps,rhs_evaluations,jacobian_evaluations,status\n"
        "bdf,1e-05,1e-07,2.5e-07,125,12,34,5,done\n"
        "adams,0.001,1e-05,inf,1e+06,12,34,5,failed\n");
}

}  // namespace bbsim_test::test_accuracy
