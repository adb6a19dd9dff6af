// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "record/track/kernels/rows.hpp"

namespace bbsim::record {

struct BaselineRows {
  static constexpr int lanes = 2;
};

extern const TrackKernels track_kernels_baseline;
constinit const TrackKernels track_kernels_baseline = RowKernels<BaselineRows>::kernels;

}  // namespace bbsim::record
