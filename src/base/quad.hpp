// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A 113-bit floating-point number for reference solutions.
//
// On x86-64 with glibc 2.26 or later it is __float128, with glibc's sine and cosine. (libquadmath
// would be one more library to load when the program starts.) Elsewhere it is long double, which
// has 113 bits on AArch64 and fewer on some other machines.
#pragma once

#include <cmath>
#include <limits>

#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GLIBC_PREREQ)
#if __GLIBC_PREREQ(2, 26)
#define BBSIM_HAS_FLOAT128 1
#endif
#endif

#include "base/real.hpp"

namespace bbsim {

namespace quad_detail {

#ifdef BBSIM_HAS_FLOAT128
__extension__ using Storage = __float128;
inline constexpr int digits = 113;
// glibc declares the function only for some compilers, and not always with this type. This
// declaration gives the symbol a name of our own.
extern "C" void bbsim_sincosf128(Storage angle, Storage* sin, Storage* cos) noexcept
    __asm__("sincosf128");
inline void sin_cos(Storage angle, Storage* sin, Storage* cos) {
  bbsim_sincosf128(angle, sin, cos);
}
#else
using Storage = long double;
inline constexpr int digits = std::numeric_limits<long double>::digits;
inline void sin_cos(Storage angle, Storage* sin, Storage* cos) {
  *sin = std::sin(angle);
  *cos = std::cos(angle);
}
#endif

}  // namespace quad_detail

// A class, not an alias, so that argument-dependent lookup finds its overloads.
class Quad {
 public:
  Quad() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): a double is a Quad, exactly
  constexpr Quad(double value) : value_(value) {}

  explicit constexpr operator double() const { return static_cast<double>(value_); }

  friend constexpr Quad operator-(Quad a) { return from(-a.value_); }
  friend constexpr Quad operator+(Quad a, Quad b) { return from(a.value_ + b.value_); }
  friend constexpr Quad operator-(Quad a, Quad b) { return from(a.value_ - b.value_); }
  friend constexpr Quad operator*(Quad a, Quad b) { return from(a.value_ * b.value_); }
  friend constexpr Quad operator/(Quad a, Quad b) { return from(a.value_ / b.value_); }
  friend constexpr bool operator==(Quad a, Quad b) { return a.value_ == b.value_; }
  friend constexpr bool operator<(Quad a, Quad b) { return a.value_ < b.value_; }
  friend constexpr bool operator>(Quad a, Quad b) { return b < a; }
  friend constexpr bool operator<=(Quad a, Quad b) { return a.value_ <= b.value_; }
  friend constexpr bool operator>=(Quad a, Quad b) { return b <= a; }

  constexpr Quad& operator+=(Quad b) { return *this = *this + b; }
  constexpr Quad& operator-=(Quad b) { return *this = *this - b; }
  constexpr Quad& operator*=(Quad b) { return *this = *this * b; }
  constexpr Quad& operator/=(Quad b) { return *this = *this / b; }

  // The distance from 1 to the next number: 1.9e-34 with 113 bits.
  static constexpr double epsilon() {
    double epsilon = 1;
    for (int bit = 1; bit < quad_detail::digits; ++bit) epsilon /= 2;
    return epsilon;
  }

  // Sine and cosine together; `angle` in rad.
  friend void sin_cos(Quad angle, Quad* sin, Quad* cos) {
    quad_detail::sin_cos(angle.value_, &sin->value_, &cos->value_);
  }

 private:
  static constexpr Quad from(quad_detail::Storage value) {
    Quad quad(0.0);
    quad.value_ = value;
    return quad;
  }

  quad_detail::Storage value_;
};

[[nodiscard]] constexpr Quad abs(Quad a) {
  return a < Quad(0.0) ? -a : a;
}

// Rounded to double.
[[nodiscard]] constexpr double plain(Quad a) {
  return static_cast<double>(a);
}

[[nodiscard]] constexpr double value_of(Quad a) {
  return plain(a);
}

// Each Newton iteration doubles the number of correct digits, starting from a double's root.
[[nodiscard]] inline Quad root_along(Quad square, Quad along) {
  Quad root(std::sqrt(plain(square)));
  if (root > Quad(0.0)) {
    for (int i = 0; i < 2; ++i) root = (root + square / root) / Quad(2.0);
  }
  return along < Quad(0.0) ? -root : root;
}

[[nodiscard]] inline SinCos<Quad> sin_cos(const Quad& angle) {
  SinCos<Quad> direction;
  sin_cos(angle, &direction.sin, &direction.cos);
  return direction;
}

}  // namespace bbsim
