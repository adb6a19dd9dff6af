// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solve/loop/step.hpp"

namespace bbsim::solve::loop {

struct Avx2 {
  static constexpr int lanes = 4;
};

extern const Kernels kernels_avx2;
constinit const Kernels kernels_avx2 = kernels_of<Avx2>;

}  // namespace bbsim::solve::loop
