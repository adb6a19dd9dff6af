// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solve/sampled/lane_piece.hpp"

namespace bbsim::solve::sampled {

struct Avx512 {
  static constexpr int lanes = 8;
};

extern const Kernels kernels_avx512;
constinit const Kernels kernels_avx512 = Kernel<Avx512>::kernels;
extern const LaneKernels lane_kernels_avx512;
constinit const LaneKernels lane_kernels_avx512 = LaneKernel<Avx512>::kernels;

}  // namespace bbsim::solve::sampled
