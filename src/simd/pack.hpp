// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A pack of doubles, one per SIMD lane, and numbers made of packs.
//
// Included only by the kernels, which are compiled once for each instruction set. Every type has
// the set as a tag, and every function is inlined or takes a tagged type. The linker can therefore
// not use code for one set in place of code for another.
#pragma once

#include "base/real.hpp"
#include "simd/sine_table.hpp"

#define BBSIM_INLINE [[gnu::always_inline]] inline

namespace bbsim::simd {

// The compilers' own vector types (GCC, Clang).
template <int lanes>
struct Vectors;
template <>
struct Vectors<2> {
  typedef double Number __attribute__((vector_size(16)));
  typedef long long Mask __attribute__((vector_size(16)));
};
template <>
struct Vectors<4> {
  typedef double Number __attribute__((vector_size(32)));
  typedef long long Mask __attribute__((vector_size(32)));
};
template <>
struct Vectors<8> {
  typedef double Number __attribute__((vector_size(64)));
  typedef long long Mask __attribute__((vector_size(64)));
};

template <class Isa, int lanes>
struct Pack {
  static constexpr int size = lanes;
  using Vector = typename Vectors<lanes>::Number;
  using Mask = typename Vectors<lanes>::Mask;
  Vector v;

  BBSIM_INLINE Pack() {}  // NOLINT(modernize-use-equals-default): uninitialised on purpose
  // Copies a pack as one vector. Compilers would copy plain memory in halves.
  BBSIM_INLINE Pack(const Pack& other) : v(other.v) {}
  BBSIM_INLINE Pack& operator=(const Pack& other) { return v = other.v, *this; }
  BBSIM_INLINE Pack(double value) : v(value - Vector{}) {}  // NOLINT(google-explicit-constructor)
  BBSIM_INLINE static Pack of(Vector v) {
    Pack p;
    p.v = v;
    return p;
  }
  // Loads `lanes` doubles, aligned to the pack's own size.
  BBSIM_INLINE static Pack load(const double* p) {
    return of(*reinterpret_cast<const Vector*>(__builtin_assume_aligned(p, sizeof(Vector))));
  }
  BBSIM_INLINE void store(double* p) const {
    *reinterpret_cast<Vector*>(__builtin_assume_aligned(p, sizeof(Vector))) = v;
  }
  // The same without alignment.
  BBSIM_INLINE static Pack load_anywhere(const double* p) {
    Pack pack;
    __builtin_memcpy(&pack.v, p, sizeof(Vector));
    return pack;
  }
  BBSIM_INLINE void store_anywhere(double* p) const { __builtin_memcpy(p, &v, sizeof(Vector)); }
  BBSIM_INLINE double operator[](int lane) const { return v[lane]; }

  BBSIM_INLINE friend Pack operator+(Pack a, Pack b) { return of(a.v + b.v); }
  BBSIM_INLINE friend Pack operator-(Pack a, Pack b) { return of(a.v - b.v); }
  BBSIM_INLINE friend Pack operator*(Pack a, Pack b) { return of(a.v * b.v); }
  BBSIM_INLINE friend Pack operator/(Pack a, Pack b) { return of(a.v / b.v); }
  BBSIM_INLINE friend Pack operator/(Pack a, int b) { return of(a.v * (1.0 / b)); }
  BBSIM_INLINE friend Pack operator-(Pack a) { return of(-a.v); }
  BBSIM_INLINE Pack& operator+=(Pack b) { return v += b.v, *this; }
  BBSIM_INLINE Pack& operator-=(Pack b) { return v -= b.v, *this; }
  // Keeps a product from being fused into the sum that uses it. In a sum of two products a compiler
  // may fuse either one; this fixes the choice.
  BBSIM_INLINE friend Pack rounded(Pack a) {
#if defined(__x86_64__)
    asm("" : "+v"(a.v));
#elif defined(__aarch64__)
    asm("" : "+w"(a.v));
#endif
    return a;
  }
  BBSIM_INLINE friend double sum(Pack a) {
    double total = a.v[0];
    for (int i = 1; i < lanes; ++i) total += a.v[i];
    return total;
  }
  BBSIM_INLINE friend Pack root_along(Pack square, Pack along) {
    Pack root;
    for (int i = 0; i < lanes; ++i) {
      root.v[i] = __builtin_copysign(__builtin_sqrt(square.v[i]), along.v[i]);
    }
    return root;
  }
  BBSIM_INLINE friend Pack value_of(Pack a) {
    return a;
  }
  // The time that selects an interval of a table. All times of a step lie between the same two
  // knots, so any lane will do.
  BBSIM_INLINE friend double plain(Pack a) {
    return a.v[0];
  }
};

// For angles within pi/4: the polynomials only.
template <class Isa, int lanes>
BBSIM_INLINE SinCos<Pack<Isa, lanes>> sin_cos_of_small(Pack<Isa, lanes> angle) {
  using P = Pack<Isa, lanes>;
  using T = SineTable;
  const typename P::Vector r = angle.v, u = r * r, u2 = u * u;
  const typename P::Vector p =
      (T::sine[0] + u * T::sine[1]) +
      u2 * ((T::sine[2] + u * T::sine[3]) + u2 * (T::sine[4] + u * T::sine[5]));
  const typename P::Vector q =
      (T::cosine[0] + u * T::cosine[1]) +
      u2 * ((T::cosine[2] + u * T::cosine[3]) + u2 * (T::cosine[4] + u * T::cosine[5]));
  return {P::of(r + (r * u) * p), P::of(1.0 + (u * -0.5 + u2 * q))};
}

// Within about 1 ulp of the true value up to 10^5 rad: Cody and Waite's reduction by multiples of
// pi/2, then minimax polynomials. Beyond that, the reduction loses digits.
template <class Isa, int lanes>
BBSIM_INLINE SinCos<Pack<Isa, lanes>> sin_cos_of_moderate(Pack<Isa, lanes> angle) {
  using P = Pack<Isa, lanes>;
  using Vector = typename P::Vector;
  using Mask = typename P::Mask;
  using T = SineTable;
  // Adding 1.5 * 2^52 rounds to an integer and leaves it in the low bits.
  const Vector magic = 6755399441055744.0 - Vector{};
  const Vector shifted = angle.v * T::two_over_pi + magic;
  const Vector turns = shifted - magic;
  const Mask quadrant = (Mask)shifted;
  const Vector r =
      ((angle.v - turns * T::half_pi[0]) - turns * T::half_pi[1]) - turns * T::half_pi[2];
  const SinCos<P> within = sin_cos_of_small(P::of(r));
  const Vector s = within.sin.v, c = within.cos.v;
  const Mask odd = -(quadrant & 1);
  const Mask sign_bit = (1LL << 63) - Mask{};
  const Mask sine_sign = (quadrant << 62) & sign_bit;
  const Mask cosine_sign = ((quadrant + 1) << 62) & sign_bit;
  SinCos<P> result;
  result.sin = P::of((Vector)((((Mask)c & odd) | ((Mask)s & ~odd)) ^ sine_sign));
  result.cos = P::of((Vector)((((Mask)s & odd) | ((Mask)c & ~odd)) ^ cosine_sign));
  return result;
}

// The same up to 10^5 rad. Beyond that, uses the C library, in the affected lanes only.
template <class Isa, int lanes>
BBSIM_INLINE SinCos<Pack<Isa, lanes>> sin_cos(Pack<Isa, lanes> angle) {
  using P = Pack<Isa, lanes>;
  SinCos<P> result = sin_cos_of_moderate(angle);
  const typename P::Mask small = (angle.v < 1e5) & (angle.v > -1e5);
  long long all = small[0];
  for (int i = 1; i < lanes; ++i) all &= small[i];
  if (__builtin_expect(all == 0, 0)) {
    for (int i = 0; i < lanes; ++i) {
      if (small[i] != 0) continue;
      result.sin.v[i] = __builtin_sin(angle.v[i]);
      result.cos.v[i] = __builtin_cos(angle.v[i]);
    }
  }
  return result;
}

}  // namespace bbsim::simd
