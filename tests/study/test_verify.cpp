// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// bbsim verify: its checks, and the simpler models against their known errors.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "catch.hpp"
#include "scenario/reader.hpp"
#include "study/verify.hpp"

namespace bbsim_test::test_verify {

using namespace bbsim;
using study::Check;

namespace {

Scenario moved(Profile phi, Profile theta) {
  Scenario scene;
  scene.ball = {.radius = 0.01, .position = {0.05, 0}};
  scene.gimbal.motion = {std::move(phi), std::move(theta)};
  scene.time = {2, 0.1};
  return scene;
}

}  // namespace

TEST_CASE("all checks of this build pass, and none is vacuous") {
  const study::Verification made = study::verify();
  CHECK(made.holds());
  CHECK(made.checks.size() == 10);
  for (const Check& check : made.checks) {
    CAPTURE(check.name, check.error, check.bound);
    CHECK(check.holds());
    CHECK(check.bound > 0);
    CHECK(check.bound < 1e-6);  // 1e-9 of the largest position, of 1.3 km
  }
}

TEST_CASE("a check fails if its error exceeds the bound or is NaN") {
  CHECK(Check{"", 1, 1}.holds());
  CHECK_FALSE(Check{"", 1.1, 1}.holds());
  CHECK_FALSE(Check{"", std::numeric_limits<double>::quiet_NaN(), 1}.holds());
  CHECK_FALSE(Check{"", std::numeric_limits<double>::infinity(), 1}.holds());
  study::Verification made;
  made.checks = {{"", 0, 1}, {"", 2, 1}};
  CHECK_FALSE(made.holds());
}

TEST_CASE("a stop request ends the verification") {
  const std::atomic<bool> stop{true};
  const study::Verification made = study::verify({&stop, {}});
  CHECK(made.interrupted);
  CHECK(made.checks.empty());
  CHECK_FALSE(made.holds());
}

// The simpler models run at rtol 1e-9: over 2 s and a few meters, some hundred steps of BDF leave
// less than 1e-6 m.
TEST_CASE("simpler models on a fixed incline: the textbook's lacks a cosine, slope is exact") {
  const Scenario scene = moved({0.2}, {-0.3});
  const study::FullModelStudy made = study::compare_simpler(scene);
  REQUIRE(made.simpler.size() == 2);
  CHECK(made.reached == 2);
  CHECK(made.simpler[0].dx < 1e-6);
  CHECK(made.simpler[0].dy < 1e-6);
  CHECK(made.simpler[1].dx < 1e-6);
  const double missing = 5.0 / 14 * scene.gravity * std::sin(0.3) * (1 - std::cos(0.2)) * 4;
  CHECK(std::abs(made.simpler[1].dy - missing) < 1e-6);
  CHECK(made.simpler[1].at_dy == 2);
}

TEST_CASE("simpler models on a turning plane: slope lacks x phi'^2, the textbook's is exact") {
  const Scenario scene = moved({Ramp{0, 1}}, {});
  const study::FullModelStudy made = study::compare_simpler(scene);
  const double g = scene.gravity, k = std::sqrt(5.0 / 7), t = 2;
  // (M2), and 7 x'' = 5 g sin t integrated twice.
  const double full =
      0.05 * std::cosh(k * t) + 5 * g / (12 * k) * std::sinh(k * t) - 5 * g / 12 * std::sin(t);
  const double slope = 0.05 + 5.0 / 7 * g * (t - std::sin(t));
  CHECK(std::abs(made.simpler[0].dx - (full - slope)) < 1e-6);
  CHECK(made.simpler[1].dx < 1e-6);
  CHECK(made.simpler[0].dy == 0);
  CHECK(made.simpler[1].dy == 0);
}

TEST_CASE("the same controller acts on the simpler ball") {
  const Scenario scene =
      read_scenario(BBSIM_SOURCE_DIR "/tests/data/scenarios/fig2b.yaml", {"time.end=30"});
  const study::FullModelStudy made = study::compare_simpler(scene);
  for (const study::SimplerModel& model : made.simpler) {
    CHECK(model.reached == 30);
    // A stable loop moves either ball around the same circle of 5 cm, with a difference below a
    // hundredth of it. Without the loop the models diverge as t^2.
    CHECK(std::max(model.dx, model.dy) < 5e-4);
    CHECK(std::max(model.dx, model.dy) > 1e-6);
  }
}

TEST_CASE("diverging models are compared as far as they go") {
  const study::FullModelStudy made = study::compare_simpler(
      read_scenario(BBSIM_SOURCE_DIR "/tests/data/scenarios/fig2b-literal.yaml"));
  CHECK(made.reached < 0.75);
  for (const study::SimplerModel& model : made.simpler) {
    CHECK(model.reached > 0.5);
    CHECK(model.reached < 0.75);
    CHECK(std::isfinite(model.dx));
    CHECK(std::isfinite(model.dy));
  }
}

}  // namespace bbsim_test::test_verify
