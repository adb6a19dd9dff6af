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

[[nodiscard]] sweep::CaseFileLayout layout_of(const SweepFacts& facts, sweep::CaseRange range);

// Everything that the results depend on, as JSON (sweep/plan_text.hpp).
[[nodiscard]] std::string plan_text(const SweepFacts& facts);

[[nodiscard]] file::Attributes attributes_of(const SweepFacts& facts, const sweep::Engine& engine);

// "case 3 is stopped (edge); repeat it with" and the command.
[[nodiscard]] std::string repeat_text(const SweepFacts& facts, const sweep::FailedCase& failed);

// The plan and the outcome of the sweep, as JSON.
[[nodiscard]] std::string summary_text(const SweepFacts& facts, const SweepResult& result);

}  // namespace bbsim::api
