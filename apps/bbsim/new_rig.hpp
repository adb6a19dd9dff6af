// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The scenario that `bbsim new rig` writes: a template, filled in for a plate, a ball, servos and a
// sensor, with gains that suit the delays.
#pragma once

#include <string>
#include <vector>

namespace bbsim::app {

// Those of servo.model.
[[nodiscard]] std::vector<std::string> servo_classes();

// In the words of the options. What is empty was not said.
struct RigWords {
  std::string plate, ball, servo, camera, touch, legs;

  // The name of the first option that was given, if one was.
  [[nodiscard]] std::string first_given() const;
};

// Asks for each on standard error, and reads the answers from standard input, a terminal. An empty
// one leaves the default, the end of the input all the rest.
void ask(RigWords& words);

// The scenario, as it stands in `file`. Throws InputError.
[[nodiscard]] std::string rig_scenario(const RigWords& words, const std::string& file);

}  // namespace bbsim::app
