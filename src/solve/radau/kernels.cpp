// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simd/instruction_set.hpp"
#include "solve/radau/radau.hpp"

namespace bbsim::solve::radau {

extern const StepKernels kernels_baseline;
#ifdef BBSIM_X86_KERNELS
extern const StepKernels kernels_avx2;
extern const StepKernels kernels_avx512;
#endif

const StepKernels& kernels_for([[maybe_unused]] simd::InstructionSet set) {
#ifdef BBSIM_X86_KERNELS
  return simd::pick(set, kernels_baseline, kernels_avx2, kernels_avx512);
#else
  return kernels_baseline;
#endif
}

const StepKernels& choose_kernels() {
  return kernels_for(simd::chosen_instruction_set());
}

}  // namespace bbsim::solve::radau
