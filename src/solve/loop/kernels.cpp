// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simd/instruction_set.hpp"
#include "solve/loop/kernel.hpp"

namespace bbsim::solve::loop {

extern const Kernels kernels_baseline;
#ifdef BBSIM_X86_KERNELS
extern const Kernels kernels_avx2;
extern const Kernels kernels_avx512;
#endif

const Kernels& choose_kernels() {
#ifdef BBSIM_X86_KERNELS
  return simd::pick(simd::chosen_instruction_set(), kernels_baseline, kernels_avx2, kernels_avx512);
#else
  return kernels_baseline;
#endif
}

}  // namespace bbsim::solve::loop
