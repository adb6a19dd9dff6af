// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Checks and texts that both formats of merge.hpp share.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace bbsim::sweep {

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
