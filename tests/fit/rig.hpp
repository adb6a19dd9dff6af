// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A rig with known parameters, and its logs.
#pragma once

#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include "api/run.hpp"
#include "base/number_text.hpp"
#include "scenario/family.hpp"
#include "support/folder.hpp"

// The true rig: two servos follow sines of different periods, starting at their greatest angles so
// that the ball does not drift.
inline const std::string true_rig = R"(
ball: {radius: 1 cm, position: [2 cm, -1 cm], inertia_factor: 0.43}
gimbal:
  motion:
    phi:
      - {sinusoid: {amplitude: 3 deg, frequency: 5.3 rad/s, phase: 1.5708 rad}}
      - {sinusoid: {amplitude: 2 deg, frequency: 2.9 rad/s, phase: 1.5708 rad}}
    theta:
      - {sinusoid: {amplitude: 3 deg, frequency: 4.1 rad/s, phase: 1.5708 rad}}
      - {sinusoid: {amplitude: 2 deg, frequency: 7.7 rad/s, phase: 1.5708 rad}}
time: {end: 20, step: 50 ms}
output: {columns: [t, x, y, phi, theta]}
)";

// The rig as its owner believes it to be.
inline const std::string assumed_rig = R"(# A rig, as bought.
ball: {radius: 1 cm}  # solid
gimbal:
  motion:
    phi: {table: {file: log.csv, time: t, value: phi}}
    theta: {table: {file: log.csv, time: t, value: theta}}
time: {end: 10, step: 50 ms}
)";

// Rows of the true rig, with noise of `sd` (m) on the ball, rounded to `step` (m), and phi from a
// gauge that reads (phi - offset) / scale.
inline std::string log_text(double sd, double scale = 1, double offset = 0, unsigned seed = 1,
                            const std::string& scenario = true_rig, double step = 0) {
  const bbsim::ScenarioFamily family(bbsim::Source{"true.yaml", scenario, {}});
  bbsim::api::RunRequest request{family.read({})};
  request.keeps_rows = true;
  bbsim::api::Watch watch;
  const bbsim::api::RunResult made = bbsim::api::run(request, watch);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0, 1);
  std::string text = "t,x,y,phi,theta\n";
  const auto& columns = made.rows.columns;
  for (std::size_t row = 0; row < columns.front().size(); ++row) {
    const double x = columns[1][row] + sd * noise(random);
    const double y = columns[2][row] + sd * noise(random);
    const auto shown = [&](double value) {
      return step > 0 ? step * std::round(value / step) : value;
    };
    const double values[] = {columns[0][row], shown(x), shown(y),
                             (columns[3][row] - offset) / scale, columns[4][row]};
    for (std::size_t c = 0; c < 5; ++c) {
      text += bbsim::number_text(values[c]) + (c < 4 ? "," : "\n");
    }
  }
  return text;
}
