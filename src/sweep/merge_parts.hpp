// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The two formats of merge.hpp, and what they share.
#pragma once

#include <set>
#include <string>

#include "sweep/merge.hpp"

namespace bbsim::sweep {

[[nodiscard]] Merged merge_csv(const std::vector<std::string>& parts, const std::string& target,
                               const std::atomic<bool>& stop);
[[nodiscard]] Merged merge_hdf5(const std::vector<std::string>& parts, const std::string& target,
                                const std::atomic<bool>& stop);

// Both throw InputError if the numbers differ.
void check_case(const std::string& file, std::size_t found, std::size_t expected);
void check_all_there(std::size_t found, const std::string& expected);

// The instruction sets that computed the parts.
using InstructionSets = std::set<std::string>;
// "avx2 and avx512"
[[nodiscard]] std::string names_of(const InstructionSets& sets);
// A note for the user if there are several sets; empty otherwise.
[[nodiscard]] std::string note_on(const InstructionSets& sets);

}  // namespace bbsim::sweep
