// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solve/open/step.hpp"

namespace bbsim::solve::open {

struct Avx512 {
  static constexpr int lanes = 8;
};

extern const Kernels kernels_avx512;
constinit const Kernels kernels_avx512 = kernels_of<Avx512>;

}  // namespace bbsim::solve::open
