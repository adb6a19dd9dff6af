// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A run that waits at each sample for commands from outside.
#pragma once

#include <memory>

#include "api/assemble.hpp"
#include "api/run.hpp"
#include "base/pair.hpp"

namespace bbsim::api {

class SteppedRun {
 public:
  // Begins the run and advances to its first sample. Commands from outside replace the scenario's
  // law. `request` has no scenario. Throws as run() does, and InputError for a scenario whose
  // controller takes no samples, and for solver.error, which repeats a run.
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
