// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The state of a run as a file: what `run --save-state` writes and `run --from-state` goes on from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace bbsim::record {

// A state is of one build, one kind of machine, and one scene: only then are the rows that follow
// those of the one run.
struct RunState {
  std::string version, instruction_set;
  std::string identity;  // of the scene: its text, what was set, its tables
  bool gamma = false;    // whether the ball's turn is integrated
  bool endless = false;  // whether the run's end was not known
  double end = 0;        // s; of a run whose end was
  double least_end = 0;  // s; of one whose end was not: its steps are those of an end from here on
  double time = 0;       // of the last row before it, s
  std::size_t next_row = 0;
  std::string state;  // solve::Part::state
};

[[nodiscard]] std::string to_bytes(RunState state);

// Throws InputError, with the file's name, where it holds no such state, whole and unchanged. A
// file that does not begin as one is not read to its end.
[[nodiscard]] RunState read_state(const std::string& file);

}  // namespace bbsim::record
