// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Radau IIA's tables by rows, what one node takes from all: for kernels that have cases in lanes
// and the nodes in a loop. A copy of each instruction set's own, since sets may share nothing.
#pragma once

#include "solve/collocation/radau_table.hpp"

namespace bbsim::solve {

template <class Isa, int s>
struct alignas(64) NodeRows {
  double c[s]{}, a[s][s]{}, a_squared[s][s]{};
  double legendre[s][s]{};  // what node j adds to coefficient m
  consteval NodeRows() {
    using Rule = radau::RadauTable<s>;
    for (int i = 0; i < s; ++i) {
      c[i] = Rule::c[i];
      for (int j = 0; j < s; ++j) {
        legendre[i][j] = Rule::legendre[i][j];
        a[i][j] = Rule::a[j][i];
        a_squared[i][j] = Rule::a_squared[j][i];
      }
    }
  }
};

}  // namespace bbsim::solve
