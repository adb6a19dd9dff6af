// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The text beside a sweep's rows that says all that they depend on: JSON, an object.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

namespace bbsim::sweep {

// How two plans differ, but for the shard that each is of, if they are `of_shards`.
struct PlanDifference {
  std::string other;  // what differs beside the instruction set: "seed, vary"; empty if nothing
  std::array<std::string, 2> instruction_sets;  // of the two, if they differ
};
[[nodiscard]] PlanDifference compare_plans(const std::string& one, const std::string& two,
                                           bool of_shards = false);

// The number of cases of the whole sweep, if the plan tells it.
[[nodiscard]] std::optional<std::size_t> cases_in(const std::string& plan);

// "unknown" if it does not tell.
[[nodiscard]] std::string instruction_set_in(const std::string& plan);

// Whether it is a plan at all.
[[nodiscard]] bool is_plan(const std::string& text);

}  // namespace bbsim::sweep
