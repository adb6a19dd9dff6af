// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The power series of a servo's impulse response (held_motion.hpp) for every number type: h = t
// (c_0 + c_1 + ...), c_0 = 1.
//
// The tables are templates on the number type. Kernels use them with packs, so each kernel has its
// own copy.
#pragma once

namespace bbsim::model {

inline constexpr int most_terms = 40;

// 1, 1, 1/2, 1/3, ... Multiplication is faster than division.
struct TermParts {
  double of[most_terms + 3]{1};
  consteval TermParts() {
    for (int n = 1; n < most_terms + 3; ++n) of[n] = 1.0 / n;
  }
};
template <class Real>
inline constexpr TermParts term_parts{};

// The coefficient c_n from c_(n-1) = `last` and c_(n-2) = `before` (0 at first). d is the damping
// times t, and k the stiffness times t^2. Only one product depends on `last`, which shortens the
// chain.
template <class Real>
[[gnu::always_inline]] inline Real next_term(const Real& d, const Real& k, const Real& last,
                                             const Real& before, int n) {
  const double part = -term_parts<Real>.of[n + 1];
  return (d * Real(part)) * last + (k * Real(term_parts<Real>.of[n] * part)) * before;
}

}  // namespace bbsim::model
