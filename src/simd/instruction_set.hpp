// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The one choice of an instruction set, for all code that is compiled once for each.
#pragma once

#include <optional>
#include <string_view>

namespace bbsim::simd {

// The sets go from the one that every processor runs to the best: pairs of lanes (SSE2 on x86-64,
// Neon on 64-bit ARM), and fours and eights of x86-64.
enum class InstructionSet { baseline, avx2, avx512 };

[[nodiscard]] const char* name_of(InstructionSet set);

// The one of that name, if this build has code for it and this processor runs it.
[[nodiscard]] std::optional<InstructionSet> find_instruction_set(std::string_view name);

// The one that the environment variable BBSIM_SIMD names, or else the best of this processor.
// Throws InputError if the variable names none.
[[nodiscard]] InstructionSet chosen_instruction_set();

// Picks the kernels for that set from those given for each.
template <class Kernels>
[[nodiscard]] const Kernels& pick(InstructionSet set, const Kernels& baseline, const Kernels& avx2,
                                  const Kernels& avx512) {
  if (set == InstructionSet::avx512) return avx512;
  return set == InstructionSet::avx2 ? avx2 : baseline;
}

}  // namespace bbsim::simd
