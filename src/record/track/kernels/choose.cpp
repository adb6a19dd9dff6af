// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "record/track/kernels/track_kernels.hpp"
#include "simd/instruction_set.hpp"

namespace bbsim::record {

extern const TrackKernels track_kernels_baseline;
#ifdef BBSIM_X86_KERNELS
extern const TrackKernels track_kernels_avx2;
extern const TrackKernels track_kernels_avx512;
#endif

const TrackKernels& choose_track_kernels() {
#ifdef BBSIM_X86_KERNELS
  return simd::pick(simd::chosen_instruction_set(), track_kernels_baseline, track_kernels_avx2,
                    track_kernels_avx512);
#else
  return track_kernels_baseline;
#endif
}

}  // namespace bbsim::record
