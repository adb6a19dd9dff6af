// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A run for a live page: with measures, and the tasks of the scenario's exercise; and rigs like its
// own.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "api/run.hpp"
#include "replay/live.hpp"
#include "scenario/exercise.hpp"
#include "scenario/family.hpp"
#include "sweep/plan.hpp"

namespace bbsim::api {

class LiveRun {
 public:
  // Asks for what a live page shows of the request's scenario: the default measures, the bounds of
  // its exercise and, if the run is checked, metrics of a step and the measures of `sweep`. Throws
  // InputError for a mistaken exercise.
  explicit LiveRun(RunRequest& request);

  // What the page shows beside that run, without its loops. Finding the keys takes longer than a
  // short run.
  [[nodiscard]] replay::Live of(const RunResult& result, bool with_keys) const;

 private:
  Source source_;
  scenario::Exercise exercise_;
};

// The open loops of the scenario, which take longer than a short run; empty without a loop that
// bbsim can linearize.
[[nodiscard]] std::optional<replay::Live::Loops> loops_of(const Scenario& scenario);

// Rigs that differ by their tolerances: the drawn keys of the scenario's sweep or, if it has none,
// within 10 % of its numbers that a learner may change. Without numbers of time, output, solver,
// events and reference. Rigs of a seed are always the same. Throws InputError if there is nothing
// to draw.
[[nodiscard]] std::vector<sweep::SweepPlan::ListedKey> drawn_rigs(const ScenarioFamily& family,
                                                                  std::size_t count);

}  // namespace bbsim::api
