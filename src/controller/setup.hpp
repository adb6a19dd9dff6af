// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The facts about a run that your own controller receives before its first sample.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "scenario/scenario.hpp"

namespace bbsim::controller {

// SI units and radians.
struct Setup {
  Drives drives = Drives::angle;
  double period = 0, delay = 0, resolution = 0, derivative_filter = 0;  // as in Sampling
  double limit = 0;  // of the command; infinite if there is none
  double end = 0;    // of the run, s
  std::vector<Parameter> parameters;
  // The number of commands that it gives, and of servos whose state it receives.
  [[nodiscard]] std::size_t commands() const { return drives == Drives::legs ? 3 : 2; }
  std::uint64_t seed = 1;             // of random parts beside the controller's sensor
  std::array<double, 3> microstep{};  // of each axis or leg, rad; 0: not a stepper
  std::vector<std::string> columns;   // names of the numbers that bbsim wants from it
  bool serial = false;                // a program at a sketch's serial line
};

// Requires a scene with your own controller.
[[nodiscard]] Setup setup_of(const Scenario& scenario);

// The program at a sketch's serial line; null without one.
[[nodiscard]] const SerialProgram* serial_program(const OwnController& own);

// That of such a program, which the scene must have.
[[nodiscard]] Setup serial_setup_of(const Scenario& scenario);

}  // namespace bbsim::controller
