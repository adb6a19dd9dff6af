// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solve/sampled/lane_piece.hpp"

namespace bbsim::solve::sampled {

struct Avx2 {
  static constexpr int lanes = 4;
};

extern const Kernels kernels_avx2;
constinit const Kernels kernels_avx2 = Kernel<Avx2>::kernels;
extern const LaneKernels lane_kernels_avx2;
constinit const LaneKernels lane_kernels_avx2 = LaneKernel<Avx2>::kernels;

}  // namespace bbsim::solve::sampled
