// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Merges the parts of a sweep into the file that one run of the sweep would have written.
#pragma once

#include <atomic>
#include <cstddef>
#include <set>
#include <string>
#include <vector>

namespace bbsim::sweep {

struct Merged {
  std::size_t cases = 0;
  bool interrupted = false;  // stopped early, and wrote nothing
  std::string note;          // a sentence about the parts for the user; may be empty
};

// Orders the parts (all CSV or all HDF5) by case and writes them to `target`, byte for byte as a
// sweep without shards writes it. Stops soon after `stop` becomes true.
//
// Throws InputError unless the parts have the same columns and hold every case from 0 exactly once.
// If the names give a number of parts (-2of3), all of them must be there. The identity of the sweep
// (the plan beside a CSV part, the attributes of an HDF5 part) must agree in everything but the
// instruction set; `note` reports a difference there. Throws OutputError.
[[nodiscard]] Merged merge_cases(const std::vector<std::string>& parts, const std::string& target,
                                 const std::atomic<bool>& stop);

// The name of a CSV part's plan; empty if it has none.
[[nodiscard]] std::string plan_of_part(const std::string& part);

// For merge_cases() only: the parts are HDF5.
[[nodiscard]] Merged merge_hdf5(const std::vector<std::string>& parts, const std::string& target,
                                const std::atomic<bool>& stop);

// What CSV and HDF5 share. Both throw InputError if the numbers differ.
void check_case(const std::string& file, std::size_t found, std::size_t expected);
void check_all_there(std::size_t found, const std::string& expected);

// The instruction sets that computed the parts.
using InstructionSets = std::set<std::string>;
// "avx2 and avx512"
[[nodiscard]] std::string names_of(const InstructionSets& sets);
// A note for the user if there are several sets; empty otherwise.
[[nodiscard]] std::string note_on(const InstructionSets& sets);

}  // namespace bbsim::sweep
