// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The file that `run --save-state` writes and from which `run --from-state` continues.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace bbsim::record {

// The state of a run. It is valid for one build, one instruction set and one scene. Otherwise the
// rows that follow would differ from those of a single run.
struct RunState {
  std::string version, instruction_set;
  std::string identity;  // of the scene: its text, overrides and tables
  bool gamma = false;    // whether the ball's spin angle is integrated
  bool endless = false;  // whether the end of the run is unknown
  double end = 0;        // of the run, s; unless it is endless
  double least_end = 0;  // s; the steps of an endless run hold for any later end
  double time = 0;       // of the last row before the state, s
  std::size_t next_row = 0;
  std::string state;  // solve::PartialRun::state
};

[[nodiscard]] std::string to_bytes(RunState state);

// Throws InputError with the file's name unless the file is a complete, undamaged state. If the
// file does not begin like a state, the rest is not read.
[[nodiscard]] RunState read_state(const std::string& file);

}  // namespace bbsim::record
