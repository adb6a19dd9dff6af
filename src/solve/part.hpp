// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A part of a run: its rows up to some row, and a state from which another part goes on.
#pragma once

#include <cstddef>
#include <limits>
#include <string>

namespace bbsim::solve {

// Parts that go on from each other hand on the rows of the one run, to the bit: a part ends within
// a step, and keeps the state before it, so that the next part makes the same step again. The grid
// is that of the whole run.
struct Part {
  // The rows from first_row on, before end_row, are this part's.
  std::size_t first_row = 0, end_row = 0;
  // To go on from; empty: from the start of the scene, and first_row is 0.
  std::string from{};
  // Whether a state is to be kept at the part's end, or where it is interrupted.
  bool keeps_state = false;
  // Where the run ends is not known: steps are made as if it never did.
  bool endless = false;

  // What came of it: the state, empty if there is none to go on from, before row next_row; and the
  // earliest end of a run that has those steps, s.
  std::string state{};
  std::size_t next_row = 0;
  double least_end = 0;
};

// Until when steps may go behind the last stop, s.
[[nodiscard]] inline double step_limit(const Part* part, double end) {
  return part != nullptr && part->endless ? std::numeric_limits<double>::infinity() : end;
}

}  // namespace bbsim::solve
