// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Kernels for every processor, with two lanes: SSE2 on x86-64, Neon on 64-bit ARM.
#include "solve/open/step.hpp"

namespace bbsim::solve::open {

struct Baseline {
  static constexpr int lanes = 2;
};

extern const Kernels kernels_baseline;
constinit const Kernels kernels_baseline = kernels_of<Baseline>;

}  // namespace bbsim::solve::open
