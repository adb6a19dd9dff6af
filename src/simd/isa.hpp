// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Instruction sets as tag types. Code for one set is a template on its tag, so that the linker
// cannot use it in place of code for another.
#pragma once

namespace bbsim::simd {

// The set that every processor has: SSE2 on x86-64, Neon on 64-bit ARM.
struct Baseline {
  static constexpr int lanes = 2;
};
struct Avx2 {
  static constexpr int lanes = 4;
};
struct Avx512 {
  static constexpr int lanes = 8;
};

}  // namespace bbsim::simd
