// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Radau IIA's tables by rows: a row has the weights of all nodes in the integral up to one node.
// They are for kernels that have cases in lanes and loop over the nodes. Each instruction set has
// its own copy, because sets must not share data.
#pragma once

#include "solve/collocation/radau_table.hpp"

namespace bbsim::solve {

template <class Isa, int s>
struct alignas(64) NodeRows {
  double c[s]{}, a[s][s]{}, a_squared[s][s]{};
  double legendre[s][s]{};  // [j][m]: contribution of node j to coefficient m
  consteval NodeRows() {
    constexpr const auto& rule = radau::radau_table<Isa, s>;
    for (int i = 0; i < s; ++i) {
      c[i] = rule.c[i];
      for (int j = 0; j < s; ++j) {
        legendre[i][j] = rule.legendre[i][j];
        a[i][j] = rule.a[j][i];
        a_squared[i][j] = rule.a_squared[j][i];
      }
    }
  }
};

}  // namespace bbsim::solve
