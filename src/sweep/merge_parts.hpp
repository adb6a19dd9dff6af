// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The two formats of merge.hpp, and what they share.
#pragma once

#include "sweep/merge.hpp"

namespace bbsim::sweep {

[[nodiscard]] Merged merge_csv(const std::vector<std::string>& parts, const std::string& target,
                               const std::atomic<bool>& stop);
[[nodiscard]] Merged merge_hdf5(const std::vector<std::string>& parts, const std::string& target,
                                const std::atomic<bool>& stop);

// Both throw InputError if the numbers differ.
void check_case(const std::string& file, std::size_t found, std::size_t expected);
void check_all_there(std::size_t found, std::size_t expected);

// The instruction sets that computed the parts.
class InstructionSets {
 public:
  void add(const std::string& name);
  // "avx2 and avx512"
  [[nodiscard]] std::string names() const;
  // A note for the user if there are several sets; empty otherwise.
  [[nodiscard]] std::string note() const;

 private:
  std::vector<std::string> names_;  // sorted, each once
};

}  // namespace bbsim::sweep
