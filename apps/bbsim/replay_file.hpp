// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Replay files, and the conversion of runs to them, for `replay` and `run --replay`.
#pragma once

#include <string>

#include "file/atomic_file.hpp"
#include "file/outputs.hpp"
#include "replay/scene.hpp"
#include "results/result.hpp"

namespace bbsim::app {

// Throws InputError unless the name ends in .html or is "-": standard output.
void require_replay_ending(const std::string& file, const std::string& option);

// Declares the replay file as an output, which messages call `what`, and the template as an input.
void declare_replay(file::Outputs& outputs, const std::string& file, const std::string& what);

// Opened before the work that it will show, so that a missing file or template is reported at once.
class ReplayFile {
 public:
  // Throws OutputError if the file cannot be written, or the template of pages is missing.
  explicit ReplayFile(const std::string& target);

  // Writes the whole file or nothing, and reports it. Throws InputError, OutputError.
  void write(const replay::Scene& scene, bool quiet);

 private:
  std::string target_;
  std::string template_;
  file::AtomicFile file_;
};

// Run of a result, described by its scenario: fully if the scenario and its tables can still be
// read, else by the parts that can.
[[nodiscard]] replay::Run run_of(results::Result result, const std::string& name);

// Scene of one run, titled after the run or its name.
[[nodiscard]] replay::Scene scene_of(replay::Run run);

}  // namespace bbsim::app
