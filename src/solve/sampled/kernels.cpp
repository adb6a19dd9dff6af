// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simd/instruction_set.hpp"
#include "solve/sampled/lane_kernel.hpp"
#include "solve/sampled/sampled.hpp"

namespace bbsim::solve::sampled {

extern const Kernels kernels_baseline;
extern const LaneKernels lane_kernels_baseline;
#ifdef BBSIM_X86_KERNELS
extern const Kernels kernels_avx2;
extern const Kernels kernels_avx512;
extern const LaneKernels lane_kernels_avx2;
extern const LaneKernels lane_kernels_avx512;
#endif

const Kernels& choose_kernels() {
#ifdef BBSIM_X86_KERNELS
  return simd::pick(simd::chosen_instruction_set(), kernels_baseline, kernels_avx2, kernels_avx512);
#else
  return kernels_baseline;
#endif
}

const LaneKernels& choose_lane_kernels() {
#ifdef BBSIM_X86_KERNELS
  return simd::pick(simd::chosen_instruction_set(), lane_kernels_baseline, lane_kernels_avx2,
                    lane_kernels_avx512);
#else
  return lane_kernels_baseline;
#endif
}

}  // namespace bbsim::solve::sampled
