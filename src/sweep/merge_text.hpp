// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What both sides of merge.hpp say.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace bbsim::sweep {

// Each throws InputError where the two differ.
void check_case(const std::string& file, std::size_t found, std::size_t expected);
void check_all_there(std::size_t found, std::size_t expected);

// The instruction sets by which the parts were computed.
class InstructionSets {
 public:
  void add(const std::string& name);
  // "avx2 and avx512"
  [[nodiscard]] std::string names() const;
  // What to say if there are several; empty if not.
  [[nodiscard]] std::string note() const;

 private:
  std::vector<std::string> names_;  // sorted, each once
};

}  // namespace bbsim::sweep
