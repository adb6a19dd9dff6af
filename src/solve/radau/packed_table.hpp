// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The tables of Radau IIA for the layout of a single run, whose nodes lie in the lanes.
//
// Included only by the kernels. See simd/pack.hpp for why everything is inlined or tagged.
#pragma once

#include "solve/collocation/radau_table.hpp"

namespace bbsim::solve::radau {

template <int count, int lanes>
inline constexpr int padded = (count + lanes - 1) / lanes* lanes;

// The tables of RadauTable, aligned and padded to whole packs. Padding stages repeat the last
// stage; padding eigenvalues are zero.
template <class Isa, int s>
struct alignas(64) PackedTable {
  static constexpr int stages = padded<s, Isa::lanes>;
  static constexpr int eigen_lanes = Isa::lanes == 8 && s == 8 ? 4 : Isa::lanes;
  static constexpr int pairs = padded<s / 2, eigen_lanes>;
  alignas(64) double c[stages]{};
  alignas(64) double lambda_re[pairs]{}, lambda_im[pairs]{};
  alignas(64) double a[s][stages]{}, a_squared[s][stages]{}, legendre[s][stages]{};
  alignas(64) double forward_re[s][pairs]{}, forward_im[s][pairs]{};
  alignas(64) double back_re[s / 2][stages]{}, back_im[s / 2][stages]{};

  consteval PackedTable() {
    constexpr const auto& of = radau_table<Isa, s>;
    for (int i = 0; i < stages; ++i) {
      const int from = i < s ? i : s - 1;
      c[i] = of.c[from];
      for (int j = 0; j < s; ++j) {
        a[j][i] = of.a[j][from];
        a_squared[j][i] = of.a_squared[j][from];
        legendre[j][i] = of.legendre[j][from];
      }
      for (int k = 0; k < s / 2; ++k) {
        back_re[k][i] = of.back_re[k][from];
        back_im[k][i] = of.back_im[k][from];
      }
    }
    for (int k = 0; k < s / 2; ++k) {
      lambda_re[k] = of.lambda_re[k];
      lambda_im[k] = of.lambda_im[k];
      for (int j = 0; j < s; ++j) {
        forward_re[j][k] = of.forward_re[j][k];
        forward_im[j][k] = of.forward_im[j][k];
      }
    }
  }
};

}  // namespace bbsim::solve::radau
