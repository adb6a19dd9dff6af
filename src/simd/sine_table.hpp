// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Written by make_tables.py, which says how. Do not edit.
#pragma once

namespace bbsim::simd {

// On |r| <= pi/4, by the Remez exchange: sin r = r + r^3 p(r^2), cos r = 1 - r^2/2 + r^4 q(r^2).
// pi/2 is in three parts. The first two have 33 bits, so their products with integers below 2^20
// are exact.
struct SineTable {
  static constexpr double sine[6] = {
      -0.1666666666666666461364477,   8.333333333330938450792663e-3,
      -1.984126983674298137093166e-4, 2.755731609430811542731603e-6,
      -2.505113010180553745874925e-8, 1.591800228187307205424759e-10};
  static constexpr double cosine[6] = {
      0.04166666666666666538239409,  -1.388888888888739082759558e-3,
      2.480158729875576289716579e-5, -2.755731726649502492675659e-7,
      2.087614516358142660513505e-9, -1.138255204095506393753185e-11};
  static constexpr double half_pi[3] = {1.57079632673412561416626, 6.077100506303965976595549e-11,
                                        2.022266248795950732399685e-21};
  static constexpr double two_over_pi = 0.6366197723675813430755351;
};

}  // namespace bbsim::simd
