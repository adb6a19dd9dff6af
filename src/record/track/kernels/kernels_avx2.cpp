// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "record/track/kernels/rows.hpp"

namespace bbsim::record {

struct Avx2Rows {
  static constexpr int lanes = 4;
};

extern const TrackKernels track_kernels_avx2;
constinit const TrackKernels track_kernels_avx2 = RowKernels<Avx2Rows>::kernels;

}  // namespace bbsim::record
