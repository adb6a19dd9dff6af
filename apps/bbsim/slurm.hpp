// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The script that runs a sweep as a Slurm job array, one shard for each task.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace bbsim::app {

struct SlurmJob {
  std::string script;                // where it is written, as in the advice to submit it
  std::vector<std::string> options;  // of `bbsim sweep`, behind the scenario; one or two words each
  std::string scenario;
  std::string output, summary;  // of the sweep as a whole; no summary if empty
  std::size_t cases = 0, tasks = 1;
  std::size_t threads = 0;  // of a task; 0: as many as Slurm gives it
};
[[nodiscard]] std::string slurm_script(const SlurmJob& job);

}  // namespace bbsim::app
