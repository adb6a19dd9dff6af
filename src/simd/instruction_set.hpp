// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Chooses an instruction set for code that is compiled once for each set.
#pragma once

#include <optional>
#include <string_view>

#include "simd/isa.hpp"

namespace bbsim::simd {

// From the set that every processor has to the best: two lanes (SSE2 on x86-64, Neon on 64-bit
// ARM), and four and eight lanes of x86-64.
enum class InstructionSet { baseline, avx2, avx512 };

[[nodiscard]] const char* name_of(InstructionSet set);

// The set of that name; empty if this build or this processor does not support it.
[[nodiscard]] std::optional<InstructionSet> find_instruction_set(std::string_view name);

// The set that the environment variable BBSIM_SIMD names, otherwise the best of this processor.
// Throws InputError if the variable names no set of this processor.
[[nodiscard]] InstructionSet chosen_instruction_set();

// The nodes of one run are too few to fill eight lanes, so kernels of single runs stop at AVX2.
enum class Widest { avx2, avx512 };

// Returns get(tag), with the tag of `set`, or of the widest set that the kernels are compiled for.
template <Widest widest = Widest::avx512, class Get>
[[nodiscard]] const auto& kernels_by(Get get, InstructionSet set = chosen_instruction_set()) {
#ifdef BBSIM_X86_KERNELS
  if constexpr (widest == Widest::avx512) {
    if (set == InstructionSet::avx512) return get(Avx512());
  }
  if (set != InstructionSet::baseline) return get(Avx2());
#else
  static_cast<void>(set);
#endif
  return get(Baseline());
}

}  // namespace bbsim::simd
