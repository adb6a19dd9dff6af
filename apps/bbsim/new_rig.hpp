// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// `bbsim new rig`: a template filled in for a plate, a ball, servos and a sensor, with gains that
// suit the delays.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace bbsim::app {

// The values of servo.model.
[[nodiscard]] std::vector<std::string> servo_classes();

// Values of the options as text, by their names, such as --plate; empty or absent: not given.
using RigWords = std::map<std::string, std::string>;

// Asks for each on standard error and reads the answers from standard input, a terminal. An empty
// answer keeps the default, and the end of the input keeps all remaining defaults.
void ask(RigWords& words);

// Text of the scenario for `file`. Throws InputError.
[[nodiscard]] std::string rig_scenario(const RigWords& words, const std::string& file);

}  // namespace bbsim::app
