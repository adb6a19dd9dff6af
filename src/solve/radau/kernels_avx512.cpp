// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solve/radau/kernels.hpp"

namespace bbsim::solve::radau {

struct Avx512 {
  static constexpr int lanes = 8;
};

extern const StepKernels kernels_avx512;
constinit const StepKernels kernels_avx512 = kernels_of<Avx512>();

}  // namespace bbsim::solve::radau
