// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "record/track/kernels/rows.hpp"

namespace bbsim::record {

struct Avx512Rows {
  static constexpr int lanes = 8;
};

extern const TrackKernels track_kernels_avx512;
constinit const TrackKernels track_kernels_avx512 = RowKernels<Avx512Rows>::kernels;

}  // namespace bbsim::record
