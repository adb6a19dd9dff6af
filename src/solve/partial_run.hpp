// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A part of a run: a range of its rows, and a state from which the next part continues.
#pragma once

#include <cstddef>
#include <limits>
#include <string>

namespace bbsim::solve {

// Consecutive parts give the same rows as one whole run, bit for bit. A part ends within a step and
// keeps the state before that step, which the next part repeats. The grid is that of the whole run.
struct PartialRun {
  // Rows of this part: first_row up to but not including end_row.
  std::size_t first_row = 0, end_row = 0;
  // The state to continue from. If empty, the part starts the scene, and first_row is 0.
  std::string from{};
  // Whether to keep a state at the end of the part, or at an interruption.
  bool keeps_state = false;
  // Whether the end of the run is unknown. Steps are then made as if there were none.
  bool endless = false;

  // Results: the state before row next_row (empty if the part cannot be continued), and the
  // earliest end (s) of a run with the same steps.
  std::string state{};
  std::size_t next_row = 0;
  double least_end = 0;
};

// The limit of steps after the last stop, s.
[[nodiscard]] inline double step_limit(const PartialRun* part, double end) {
  return part != nullptr && part->endless ? std::numeric_limits<double>::infinity() : end;
}

}  // namespace bbsim::solve
