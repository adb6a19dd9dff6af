// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A run that waits at each sample for commands from outside.
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

// What a controller receives at a sample (docs/reference/controllers.md), SI.
struct Sample {
  std::size_t number = 0;
  double t = 0;
  std::optional<Pair> ball;
  Pair reference{}, reference_rate{}, reference_acceleration{};
  std::size_t commands = 2;  // number of commands; three, like the servos, under drives: legs
  std::array<double, 3> servo{}, servo_rate{};
};

[[nodiscard]] Sample copy_of(const model::ControllerSample& sample);

// Replaces the scenario's law with commands from outside. Throws InputError if its controller takes
// no samples, or drives legs.
[[nodiscard]] Scenario with_outside_commands(Scenario scenario);

// Throws InputError for a command that is not finite.
void require_finite(const Pair& command);

class SteppedRun {
 public:
  // Begins the run and advances to its first sample. Commands from outside replace the scenario's
  // law. `request` has no scenario. Throws as run() does, and InputError for a scenario whose
  // controller takes no samples.
  SteppedRun(const Scenario& scenario, RunRequest request);
  // Ends a run that is not over.
  ~SteppedRun();
  SteppedRun(const SteppedRun&) = delete;
  SteppedRun& operator=(const SteppedRun&) = delete;

  [[nodiscard]] bool is_over() const;
  // Sample that waits for its commands; the last one if the run is over.
  [[nodiscard]] const Sample& sample() const;
  // Applies commands for phi and theta, and advances to the next sample or to the end. The run must
  // not be over. Throws InputError for commands that are not finite, and within itself, where
  // `rows_to` is called.
  void step(Pair command);
  // Result of a run that is over.
  [[nodiscard]] const RunResult& result() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace bbsim::api
