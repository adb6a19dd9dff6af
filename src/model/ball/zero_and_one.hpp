// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Zero and One as types, so that the compiler drops terms that a scene does not have.
//
// A planar scene passes Zero for coordinates that stay zero, and One for the cosine of an angle
// that stays zero. This keeps one formula for equation (27).
#pragma once

#include <type_traits>

namespace bbsim::model {

struct Zero {
  template <class Real>
  // NOLINTNEXTLINE(google-explicit-constructor): a Zero is any number's zero
  constexpr operator Real() const requires std::is_constructible_v<Real, double> {
    return Real(0.0);
  }
};

struct One {};

template <class T>
concept Known = std::is_same_v<T, Zero> || std::is_same_v<T, One>;

template <class T>
concept Number = !Known<T>;

// Always inlined: their mangled names may contain no number type, so the linker could use a copy
// compiled for one instruction set in code for another.
[[gnu::always_inline]] constexpr Zero operator*(Zero, Zero) {
  return {};
}
[[gnu::always_inline]] constexpr Zero operator*(Zero, One) {
  return {};
}
[[gnu::always_inline]] constexpr Zero operator*(One, Zero) {
  return {};
}
[[gnu::always_inline]] constexpr One operator*(One, One) {
  return {};
}
[[gnu::always_inline]] constexpr Zero operator+(Zero, Zero) {
  return {};
}
[[gnu::always_inline]] constexpr Zero operator-(Zero, Zero) {
  return {};
}
[[gnu::always_inline]] constexpr Zero operator-(Zero) {
  return {};
}

template <Number T>
[[gnu::always_inline]] constexpr Zero operator*(Zero, const T&) {
  return {};
}
template <Number T>
[[gnu::always_inline]] constexpr Zero operator*(const T&, Zero) {
  return {};
}
template <Number T>
[[gnu::always_inline]] constexpr Zero operator/(Zero, const T&) {
  return {};
}

template <Number T>
[[gnu::always_inline]] constexpr T operator*(One, const T& a) {
  return a;
}
template <Number T>
[[gnu::always_inline]] constexpr T operator*(const T& a, One) {
  return a;
}

template <Number T>
[[gnu::always_inline]] constexpr T operator+(Zero, const T& a) {
  return a;
}
template <Number T>
[[gnu::always_inline]] constexpr T operator+(const T& a, Zero) {
  return a;
}
template <Number T>
[[gnu::always_inline]] constexpr T operator-(const T& a, Zero) {
  return a;
}
template <Number T>
[[gnu::always_inline]] constexpr auto operator-(Zero, const T& a) {
  return -a;
}

}  // namespace bbsim::model
