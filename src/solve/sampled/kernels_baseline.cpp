// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// For every processor: pairs of lanes, which are SSE2 on x86-64 and Neon on 64-bit ARM.
#include "solve/sampled/lane_piece.hpp"

namespace bbsim::solve::sampled {

struct Baseline {
  static constexpr int lanes = 2;
};

extern const Kernels kernels_baseline;
constinit const Kernels kernels_baseline = Kernel<Baseline>::kernels;
extern const LaneKernels lane_kernels_baseline;
constinit const LaneKernels lane_kernels_baseline = LaneKernel<Baseline>::kernels;

}  // namespace bbsim::solve::sampled
