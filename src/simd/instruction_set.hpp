// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The choice of an instruction set, for all code that is compiled once for each.
#pragma once

#include <optional>
#include <string_view>

namespace bbsim::simd {

// From the set that every processor has to the best: two lanes (SSE2 on x86-64, Neon on 64-bit
// ARM), and four and eight lanes of x86-64.
enum class InstructionSet { baseline, avx2, avx512 };

[[nodiscard]] const char* name_of(InstructionSet set);

// The set of that name; empty if this build has no code for it or this processor does not support
// it.
[[nodiscard]] std::optional<InstructionSet> find_instruction_set(std::string_view name);

// The set that the environment variable BBSIM_SIMD names, otherwise the best of this processor.
// Throws InputError if the variable names no set of this processor.
[[nodiscard]] InstructionSet chosen_instruction_set();

// Picks the kernels for `set`.
template <class Kernels>
[[nodiscard]] const Kernels& pick(InstructionSet set, const Kernels& baseline, const Kernels& avx2,
                                  const Kernels& avx512) {
  if (set == InstructionSet::avx512) return avx512;
  return set == InstructionSet::avx2 ? avx2 : baseline;
}

}  // namespace bbsim::simd
