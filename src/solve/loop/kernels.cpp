// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Compiled once for each instruction set (cmake/kernels.cmake).
#include "simd/isa.hpp"
#include "solve/loop/step.hpp"

namespace bbsim::solve::loop {

template <class Isa>
const Kernels& kernels() {
  static constexpr Kernels table = kernels_of<Isa>;
  return table;
}
template const Kernels& kernels<BBSIM_ISA>();

}  // namespace bbsim::solve::loop
