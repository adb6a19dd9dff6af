// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solve/radau/kernels.hpp"

namespace bbsim::solve::radau {

struct Avx2 {
  static constexpr int lanes = 4;
};

extern const StepKernels kernels_avx2;
constinit const StepKernels kernels_avx2 = kernels_of<Avx2>();

}  // namespace bbsim::solve::radau
