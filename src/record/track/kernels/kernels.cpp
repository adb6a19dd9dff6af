// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Compiled once for each instruction set (cmake/kernels.cmake).
#include "record/track/kernels/rows.hpp"
#include "simd/isa.hpp"

namespace bbsim::record {

template <class Isa>
const TrackKernels& track_kernels() {
  static constexpr TrackKernels table = RowKernels<Isa>::kernels;
  return table;
}
template const TrackKernels& track_kernels<BBSIM_ISA>();

}  // namespace bbsim::record
