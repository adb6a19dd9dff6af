// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The plan beside a sweep's rows: a JSON object with everything that the rows depend on.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

namespace bbsim::sweep {

// How two plans differ. `of_shards` ignores the shard.
struct PlanDifference {
  std::string keys;  // keys that differ, except the instruction set: "seed, vary"; empty if none
  std::array<std::string, 2> instruction_sets;  // of both plans, if they differ
};
[[nodiscard]] PlanDifference compare_plans(const std::string& first, const std::string& second,
                                           bool of_shards = false);

// What a plan says of the whole sweep.
struct PlanFacts {
  std::optional<std::size_t> cases{};  // empty if the plan lacks them
  std::string instruction_set;         // "unknown" if the plan has none
};
// Empty if the text is not a JSON object.
[[nodiscard]] std::optional<PlanFacts> facts_in(const std::string& plan);

}  // namespace bbsim::sweep
