// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A number that is affine in a few variables: its value at zero, and a coefficient per variable.
//
// Evaluated with this type in place of the state, an equation that is linear in the state yields
// its own coefficients, so that they need no second formula. Only operations that keep the number
// affine exist: factors are plain numbers.
#pragma once

#include "simd/pack.hpp"

namespace bbsim::simd {

template <class P, int n>
struct Affine {
  P value;
  P by[n];

  BBSIM_INLINE Affine() {}  // NOLINT(modernize-use-equals-default): uninitialised on purpose
  BBSIM_INLINE Affine(P constant) : value(constant) {  // NOLINT(google-explicit-constructor)
#pragma GCC unroll 8
    for (int i = 0; i < n; ++i) by[i] = P(0.0);
  }
  // Variable i.
  BBSIM_INLINE static Affine variable(int i) {
    Affine result(P(0.0));
    result.by[i] = P(1.0);
    return result;
  }

  // The value at these variables.
  BBSIM_INLINE P at(const P* numbers) const {
    P sum = value;
#pragma GCC unroll 8
    for (int i = 0; i < n; ++i) sum += by[i] * numbers[i];
    return sum;
  }

  BBSIM_INLINE friend Affine operator+(const Affine& a, const Affine& b) {
    Affine sum;
    sum.value = a.value + b.value;
#pragma GCC unroll 8
    for (int i = 0; i < n; ++i) sum.by[i] = a.by[i] + b.by[i];
    return sum;
  }
  BBSIM_INLINE friend Affine operator-(const Affine& a) {
    return a * P(-1.0);
  }
  BBSIM_INLINE friend Affine operator-(const Affine& a, const Affine& b) {
    Affine rest;
    rest.value = a.value - b.value;
#pragma GCC unroll 8
    for (int i = 0; i < n; ++i) rest.by[i] = a.by[i] - b.by[i];
    return rest;
  }
  BBSIM_INLINE friend Affine operator*(const Affine& a, P b) {
    Affine product;
    product.value = a.value * b;
#pragma GCC unroll 8
    for (int i = 0; i < n; ++i) product.by[i] = a.by[i] * b;
    return product;
  }
  BBSIM_INLINE friend Affine operator*(P a, const Affine& b) {
    return b * a;
  }
  BBSIM_INLINE friend Affine operator*(double a, const Affine& b) {
    return b * P(a);
  }
  BBSIM_INLINE friend Affine operator*(int a, const Affine& b) {
    return b * P(a);
  }
  BBSIM_INLINE friend Affine operator/(const Affine& a, int b) {
    return a * P(1.0 / b);
  }
};

}  // namespace bbsim::simd
