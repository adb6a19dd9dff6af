// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A replay as a file, and how a run becomes one: for `replay`, and for `run --replay`.
#pragma once

#include <string>

#include "file/atomic_file.hpp"
#include "file/outputs.hpp"
#include "replay/scene.hpp"
#include "results/result.hpp"

namespace bbsim::app {

// Throws InputError unless the name ends in .html or .glb, or is "-", a page on standard output.
void require_replay_ending(const std::string& file, const std::string& option);

// Says that a replay is written to that file, whose name `what` gives, of the page's template.
void declare_replay(file::Outputs& outputs, const std::string& file, const std::string& what);

// Opened before the work is done that it shows: what is missing for it is said at once.
class ReplayFile {
 public:
  // Throws OutputError: the file cannot be written to, or there is no template for pages.
  explicit ReplayFile(const std::string& target);

  // Whole or not at all, and what was written is said. Throws InputError, OutputError.
  void write(const replay::Scene& scene, bool quiet);

 private:
  std::string target_;
  bool gltf_;
  std::string template_;
  file::AtomicFile file_;
};

// A result with what is known of its scenario: all of it where it and its tables can be read as
// they were, else what is sound in it.
[[nodiscard]] replay::Run run_of(results::Result result, const std::string& name);

// The scene of one run, called by the title of the run, or its name.
[[nodiscard]] replay::Scene scene_of(replay::Run run);

}  // namespace bbsim::app
