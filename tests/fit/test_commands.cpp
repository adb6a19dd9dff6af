// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Recorded commands, played through a rig's servos and fitted.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include "api/fit.hpp"
#include "api/run.hpp"
#include "base/error.hpp"
#include "base/number_text.hpp"
#include "catch.hpp"
#include "fit/window_run.hpp"
#include "scenario/columns.hpp"
#include "scenario/family.hpp"
#include "support/folder.hpp"
#include "sweep/window.hpp"

namespace bbsim_test::test_commands {

using namespace bbsim;

namespace {

using Columns = std::vector<std::vector<double>>;

Columns rows_of(const ScenarioFamily& family) {
  api::RunRequest request{family.read({})};
  request.keeps_rows = true;
  api::Watch watch;
  return api::run(request, watch).rows.columns;
}

std::string csv(const std::string& header, const Columns& columns) {
  std::string text = header + "\n";
  for (std::size_t row = 0; row < columns.front().size(); ++row) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      text += number_text(columns[c][row]) + (c + 1 < columns.size() ? "," : "\n");
    }
  }
  return text;
}

const std::string rig = R"(
ball: {radius: 2 cm, position: [5 cm, 0]}
gimbal:
  servo: {natural_frequency: 5 Hz, damping: 0.8, rate_limit: 300 deg/s, dead_band: 0.1 deg}
)";
const std::string ends = R"(
time: {end: 4, step: 20 ms}
solver: {rtol: 1e-12, atol: 1e-14}
output: {columns: [t, x, y, phi, theta, phi_command, theta_command]}
)";

}  // namespace

TEST_CASE("replaying the recorded commands of a run gives the run") {
  const Folder folder;
  const ScenarioFamily loop(Source{"rig.yaml",
                                   rig + R"(
controller:
  gravity_compensation: {kp: 10, kv: 8}
  drives: angle
  limit: 12 deg
  reference: {circle: {radius: 5 cm, rate: -0.3}}
  sampling: {period: 20 ms, resolution: 0.1 deg, derivative_filter: 30 ms}
  sensor: {resolution: 0.32 mm, noise: 0.2 mm, delay: 10 ms}
)" + ends,
                                   {}});
  const Columns run = rows_of(loop);
  folder.put("log.csv", csv("t,x,y,phi,theta,u,v", run));
  folder.put("played.yaml", rig + R"(
controller:
  commands:
    phi: {table: {file: log.csv, time: t, value: u}}
    theta: {table: {file: log.csv, time: t, value: v}}
  drives: angle
  sampling: {period: 20 ms}
)" + ends);
  const Columns played = rows_of(ScenarioFamily(folder / "played.yaml", {}));
  REQUIRE(played.front().size() == run.front().size());
  for (std::size_t row = 0; row < run.front().size(); ++row) {
    // At its rows the table equals the commands up to rounding. Nothing corrects the ball, so its
    // errors grow quadratically with time.
    for (const std::size_t servo : {3U, 4U, 5U, 6U}) {
      CHECK(played[servo][row] == Approx(run[servo][row]).margin(1e-14));
    }
    for (const std::size_t ball : {1U, 2U}) {
      CHECK(played[ball][row] == Approx(run[ball][row]).margin(1e-10));
    }
  }
}

TEST_CASE("a window of known commands continues the samples' clock and the commands in transit") {
  const std::string clock = GENERATE("", ", jitter: 2 ms");
  const std::string delay = GENERATE("0 ms", "7 ms", "65 ms");
  const std::string start = GENERATE("0 deg", "2 deg");
  CAPTURE(clock, delay, start);
  const ScenarioFamily family(Source{"rig.yaml",
                                     R"(
ball: {radius: 2 cm, position: [5 cm, 0]}
gimbal:
  servo: {natural_frequency: 5 Hz, damping: 0.8}
  start: {phi: )" + start + R"(}
controller:
  commands:
    phi: {sinusoid: {amplitude: 3 deg, frequency: 9 rad/s}}
    theta: {sinusoid: {amplitude: 4 deg, frequency: 7 rad/s, phase: 1 rad}}
  drives: angle
  sampling: {period: 20 ms, resolution: 0.1 deg, delay: )" +
                                         delay + clock + R"(}
time: {end: 4, step: 1 ms}
solver: {rtol: 1e-11, atol: 1e-13}
output: {columns: [phi, theta, phi_rate, theta_rate]}
)",
                                     {}});
  const Columns whole = rows_of(family);
  const Scenario scene = fit::prepared(family.read({}));
  std::vector<const scenario::Column*> columns;
  for (const std::string name : {"phi", "theta", "phi_rate", "theta_rate"}) {
    columns.push_back(scenario::find_column(name));
  }
  // Windows that begin between samples, at a sample, and before the first command arrives.
  for (const int first : {2013, 2020, 2507, 33, 0}) {
    CAPTURE(first);
    std::vector<double> times;
    for (int i = 0; i <= 400; ++i) times.push_back(i * 1e-3);
    const double begin = first * 1e-3;
    std::string why;
    const std::vector<double> part = fit::run_window(
        sweep::window_of(scene, begin, begin + times.back()), {}, times, columns, why);
    REQUIRE(part.size() == 4 * times.size());
    // The servos settle in the second before the window: exp(-25) of 4 degrees and 2 rad/s remains.
    const double tolerances[] = {1e-10, 1e-10, 1e-9, 1e-9};
    for (std::size_t c = 0; c < columns.size(); ++c) {
      double most = 0;
      for (std::size_t i = 0; i < times.size(); ++i) {
        most = std::max(most, std::abs(part[c * times.size() + i] -
                                       whole[c][static_cast<std::size_t>(first) + i]));
      }
      CAPTURE(c);
      CHECK(most < tolerances[c]);
    }
  }
}

TEST_CASE("servos are found from a log of their commands") {
  const std::string commands = R"(
controller:
  commands:
    phi:
      - {sinusoid: {amplitude: 3 deg, frequency: 5.3 rad/s, phase: 1.5708 rad}}
      - {sinusoid: {amplitude: 1 deg, frequency: 17 rad/s}}
    theta:
      - {sinusoid: {amplitude: 3 deg, frequency: 4.1 rad/s, phase: 1.5708 rad}}
      - {sinusoid: {amplitude: 1 deg, frequency: 13 rad/s}}
  drives: angle
)";
  const auto scene = [](const std::string& servo, const std::string& controller) {
    return "ball: {radius: 2 cm, position: [5 cm, 0]}\ngimbal:\n  servo: " + servo + controller +
           "time: {end: 20, step: 20 ms}\n"
           "output: {columns: [t, x, y, phi_command, theta_command]}\n";
  };
  Columns log = rows_of(ScenarioFamily(
      Source{"true.yaml", scene("{natural_frequency: 4 Hz, damping: 0.7}", commands), {}}));
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0, 3e-4);
  for (std::size_t row = 0; row < log.front().size(); ++row) {
    log[1][row] += noise(random);
    log[2][row] += noise(random);
    log[3][row] = (log[3][row] - 0.005) / 1.1;  // the horn and the pulse are both off
  }
  const Folder folder;
  folder.put("log.csv", csv("t,x,y,u,v", log));
  folder.put("rig.yaml", scene("{natural_frequency: 5 Hz, damping: 0.9}", R"(
controller:
  commands:
    phi: {table: {file: log.csv, time: t, value: u}}
    theta: {table: {file: log.csv, time: t, value: v}}
  drives: angle
)"));
  const ScenarioFamily family(folder / "rig.yaml", {});
  const api::FitRequest request{
      family,
      {folder / "log.csv"},
      {},
      {"gimbal.servo.natural_frequency", "gimbal.servo.damping",
       "controller.commands.phi.table.scale", "controller.commands.phi.table.offset"}};
  api::Watch watch;
  const api::FitResult made = api::fit(request, true, watch);
  CAPTURE(made.text);
  const double truth[] = {8 * std::acos(-1.0), 0.7, 1.1, 0.005};
  REQUIRE(made.fitted.parameters.size() == 4);
  CHECK(made.fitted.windows == 10);
  // An ideal rig has no servos; the effect on the ball exceeds the noise.
  for (const fit::ColumnResidual& column : made.fitted.columns) {
    REQUIRE(column.ideal);
    CHECK(*column.ideal > 1.2 * column.rms);
  }
  for (std::size_t k = 0; k < 4; ++k) {
    const fit::Parameter& one = made.fitted.parameters[k];
    CAPTURE(one.key, one.estimate, one.sd);
    CHECK(one.told);
    CHECK(std::abs(one.estimate - truth[k]) < 3.9 * one.sd);
    CHECK(one.sd < 0.1 * truth[k]);
  }
}

}  // namespace bbsim_test::test_commands
