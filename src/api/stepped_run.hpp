// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A run that waits at each sample for its commands, which come from outside.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/run.hpp"
#include "base/pair.hpp"
#include "scenario/family.hpp"

namespace bbsim::api {

// What a controller is told at a sample (docs/reference/controllers.md), SI.
struct Sample {
  std::size_t number = 0;
  double t = 0;
  std::optional<Pair> ball;
  Pair reference{}, reference_rate{}, reference_acceleration{};
  std::size_t commands = 2;  // that it asks for: three, of as many servos, under drives: legs
  std::array<double, 3> servo{}, servo_rate{};
};

[[nodiscard]] Sample copy_of(const model::ControllerSample& sample);

// The scenario with commands from outside in place of its law. Throws InputError if its controller
// takes no samples, or drives legs.
[[nodiscard]] Scenario with_outside_commands(Scenario scenario);

// Throws InputError for a command that is not finite.
void require_finite(const Pair& command);

class SteppedRun {
 public:
  // Whatever law the scenario has, commands from outside take its place. Begins the run, and goes
  // to its first sample. `request` is without a scenario. Throws as run() does, and InputError for
  // a scenario whose controller takes no samples.
  SteppedRun(const Scenario& scenario, RunRequest request);
  // Ends a run that is not over.
  ~SteppedRun();
  SteppedRun(const SteppedRun&) = delete;
  SteppedRun& operator=(const SteppedRun&) = delete;

  [[nodiscard]] bool is_over() const;
  // The sample that waits for its commands; of a run that is over, the last one.
  [[nodiscard]] const Sample& sample() const;
  // Gives the commands for phi and theta, and goes to the next sample or to the end. The run must
  // not be over. Throws InputError for commands that are not finite.
  void step(Pair command);
  // Of a run that is over.
  [[nodiscard]] const RunResult& result() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace bbsim::api
