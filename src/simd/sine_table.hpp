// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Written by make_sine_table.py, which says how. Do not edit.
#pragma once

namespace bbsim::simd {

// On |r| <= pi/4, by the Remez exchange: sin r = r + r^3 p(r^2), cos r = 1 - r^2/2 + r^4 q(r^2).
// pi/2 is in three parts. The first two have 33 bits, so their products with integers below 2^20
// are exact.
struct SineTable {
  static constexpr double sine[6] = {-0.16666666666666666,    0.00833333333333094,
                                     -0.0001984126983674298,  2.7557316094308115e-06,
                                     -2.5051130101805537e-08, 1.5918002281873072e-10};
  static constexpr double cosine[6] = {0.041666666666666664,   -0.001388888888888739,
                                       2.4801587298755762e-05, -2.7557317266495024e-07,
                                       2.087614516358143e-09,  -1.1382552040955065e-11};
  static constexpr double half_pi[3] = {1.5707963267341256, 6.077100506303966e-11,
                                        2.0222662487959506e-21};
  static constexpr double two_over_pi = 0.6366197723675814;
};

}  // namespace bbsim::simd
