// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Texts in a sweep's files, about the sweep and about each case.
#pragma once

#include <string>

#include "api/sweep.hpp"
#include "scenario/family.hpp"
#include "sweep/case_file.hpp"
#include "sweep/sweep.hpp"

namespace bbsim::api {

// A sweep about to run. `first` is the scenario of its first case.
struct SweepFacts {
  const ScenarioFamily& family;
  const Sweep& sweep;
  const sweep::SweepTask& task;
  const Scenario& first;
  Shard shard;
};

[[nodiscard]] sweep::CaseFileLayout layout_of(const SweepFacts& facts, const sweep::Engine& engine,
                                              sweep::CaseRange range);

// Everything that the results depend on, as JSON (sweep/plan_text.hpp).
[[nodiscard]] std::string plan_text(const SweepFacts& facts);

[[nodiscard]] file::Attributes attributes_of(const SweepFacts& facts, const sweep::Engine& engine);

// "case 3 is stopped (edge); repeat it with" and the command.
[[nodiscard]] std::string repeat_text(const SweepFacts& facts, const sweep::FailedCase& failed);

// The plan and the outcome of the sweep, as JSON.
[[nodiscard]] std::string summary_text(const SweepFacts& facts, const SweepResult& result);

// Whether an expectation holds in case `i` of the results. It does not if the case has no value.
[[nodiscard]] bool holds(const sweep::SweepTask& task, const sweep::CaseResults& results,
                         std::size_t i, std::size_t expectation);

// Writes rows as CSV into the results' text, on the thread that computed them.
void write_text(const sweep::SweepTask& task, sweep::CaseResults& results);

// Appends the same rows to a table with the columns of layout_of().
void append(const sweep::SweepTask& task, const sweep::CaseResults& results, SweepTable& table);

}  // namespace bbsim::api
