// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Replay files, for `replay` and `run --replay`.
#pragma once

#include <string>

#include "file/atomic_file.hpp"
#include "file/outputs.hpp"
#include "replay/scene.hpp"

namespace bbsim::app {

// Throws InputError unless the name ends in .html or is "-": standard output.
void require_replay_ending(const std::string& file, const std::string& option);

// Declares the replay file as an output, which messages call `what`, and the template as an input.
void declare_replay(file::Outputs& outputs, const std::string& file, const std::string& what);

// Opened before the work that it will show, so that a missing file or template is reported at once.
class ReplayFile {
 public:
  // Throws OutputError if the file cannot be written, or the template of pages is missing or, for a
  // live page, its engine.
  explicit ReplayFile(const std::string& target, bool live = false);

  // Writes the whole file or nothing, and reports it. Throws InputError, OutputError.
  void write(const replay::Scene& scene, bool quiet);

 private:
  std::string target_;
  std::string template_, engine_;
  file::AtomicFile file_;
};

}  // namespace bbsim::app
