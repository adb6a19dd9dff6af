// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What a sweep's files say: of the sweep, and of each case.
#pragma once

#include <string>

#include "api/sweep.hpp"
#include "scenario/family.hpp"
#include "sweep/case_file.hpp"
#include "sweep/sweep.hpp"

namespace bbsim::api {

// A sweep that is about to be run. `first` is its first case's scenario.
struct SweepFacts {
  const ScenarioFamily& family;
  const Sweep& sweep;
  const sweep::SweepTask& task;
  const Scenario& first;
  Shard shard;
};

[[nodiscard]] sweep::CaseFileLayout layout_of(const SweepFacts& facts, const sweep::Engine& engine,
                                              sweep::CaseRange range);

// All that the results depend on, as JSON (sweep/plan_text.hpp).
[[nodiscard]] std::string plan_text(const SweepFacts& facts);

[[nodiscard]] file::Attributes attributes_of(const SweepFacts& facts, const sweep::Engine& engine);

// The plan, and how it went, as JSON.
[[nodiscard]] std::string summary_text(const SweepFacts& facts, const SweepResult& result);

// The rows of some cases as CSV, into the results' text, on the thread that computed them.
void write_text(const sweep::SweepTask& task, sweep::CaseResults& results);

// The same rows into a table whose columns are those of layout_of().
void append(const sweep::SweepTask& task, const sweep::CaseResults& results, SweepTable& table);

}  // namespace bbsim::api
