// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The power series of what a servo answers to an impulse (held_motion.hpp), once for every number
// type: h = t (c_0 + c_1 + ...), c_0 = 1.
//
// Kernels use it with packs alone, and so each has tables of its own.
#pragma once

namespace bbsim::model {

inline constexpr int most_terms = 40;

// 1, 1, 1/2, 1/3, ...: products are cheaper than quotients.
struct TermParts {
  double of[most_terms + 3]{1};
  consteval TermParts() {
    for (int n = 1; n < most_terms + 3; ++n) of[n] = 1.0 / n;
  }
};
template <class Real>
inline constexpr TermParts term_parts{};

// c_n, of which `last` is the one before, and `before` the one before that, 0 at first; d is the
// damping times t, and k the stiffness times t^2. Only one product waits for the last term.
template <class Real>
[[gnu::always_inline]] inline Real next_term(const Real& d, const Real& k, const Real& last,
                                             const Real& before, int n) {
  const double part = -term_parts<Real>.of[n + 1];
  return (d * Real(part)) * last + (k * Real(term_parts<Real>.of[n] * part)) * before;
}

}  // namespace bbsim::model
