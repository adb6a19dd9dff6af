// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A scenario's `exercise`: what a learner should reach, and with which keys. No run depends on it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenario/scenario.hpp"
#include "yaml/schema.hpp"

namespace bbsim::scenario {

struct Exercise {
  struct Task {
    std::string text;
    std::string expect;  // as after `run --expect`: "max_tilt < 5 deg"
  };
  std::vector<Task> tasks;
  std::vector<std::string> free;  // keys that the learner may change
};

// Reads the section's keys and texts, as all commands do.
void read_exercise(yaml::Keys& keys, Exercise& exercise);

// The exercise of a valid scenario, if it has one. Throws InputError with all problems, each with
// its place: a bound that run --expect refuses, or a key that --set cannot change to a number or a
// name in this scenario.
[[nodiscard]] std::optional<Exercise> checked_exercise(const Scenario& scenario);

}  // namespace bbsim::scenario
