// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Compiled once for each instruction set (cmake/kernels.cmake).
#include "solve/radau/kernels.hpp"

#include "simd/isa.hpp"

namespace bbsim::solve::radau {

template <class Isa>
const StepKernels& kernels() {
  static constexpr StepKernels table = kernels_of<Isa>();
  return table;
}
template const StepKernels& kernels<BBSIM_ISA>();

}  // namespace bbsim::solve::radau
