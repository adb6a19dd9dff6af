// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Compiled once for each instruction set (cmake/kernels.cmake).
#include "simd/isa.hpp"
#include "solve/sampled/lane_piece.hpp"

namespace bbsim::solve::sampled {

#ifndef BBSIM_IS_AVX512  // simd::Widest
template <class Isa>
const Kernels& kernels() {
  static constexpr Kernels table = Kernel<Isa>::kernels;
  return table;
}
template const Kernels& kernels<BBSIM_ISA>();
#endif

template <class Isa>
const LaneKernels& lane_kernels() {
  static constexpr LaneKernels table = LaneKernel<Isa>::kernels;
  return table;
}
template const LaneKernels& lane_kernels<BBSIM_ISA>();

}  // namespace bbsim::solve::sampled
