// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A run for a live page: with measures, and the tasks of the scenario's exercise.
#pragma once

#include "api/run.hpp"
#include "replay/live.hpp"
#include "scenario/exercise.hpp"

namespace bbsim::api {

class LiveRun {
 public:
  // Asks for what a live page shows of the request's scenario: the default measures and the bounds
  // of its exercise. Throws InputError for a mistaken exercise.
  explicit LiveRun(RunRequest& request);

  // What the page shows beside that run. Finding the keys takes longer than a short run.
  [[nodiscard]] replay::Live of(const RunResult& result, bool with_keys) const;

 private:
  Source source_;
  scenario::Exercise exercise_;
};

}  // namespace bbsim::api
