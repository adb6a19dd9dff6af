// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Numbers known at compile time, so that a term which a scene does not have is not computed.
//
// A planar scene passes Zero for the coordinates that stay zero, and One for the cosine of an
// angle that does: equation (27) then loses those terms in the compiler, not in a second formula.
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

// Inlined at every level of optimisation: these have no type of a number in their names, so that
// a copy compiled for one instruction set could otherwise be linked into code for another.
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
