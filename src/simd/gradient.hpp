// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A value with its gradient, for exact derivatives by forward differentiation.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "base/real.hpp"

namespace bbsim::simd {

// A function's value and its partial derivatives with respect to n variables.
//
// Every operation is evaluated immediately. Eigen's AutoDiffScalar builds one expression of the
// whole right-hand side instead; with sanitizers a compiler takes seven minutes for bbsim's
// systems.
template <int n>
struct WithGradient {
  using Gradient = Eigen::Matrix<double, n, 1>;
  double value = 0;
  Gradient gradient = Gradient::Zero();

  WithGradient() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): a constant is a number like any other
  WithGradient(double constant) : value(constant) {}
  WithGradient(double v, const Gradient& g) : value(v), gradient(g) {}

  // Variable i, with value v.
  static WithGradient variable(double v, int i) { return {v, Gradient::Unit(i)}; }

  friend WithGradient operator+(const WithGradient& a, const WithGradient& b) {
    return {a.value + b.value, a.gradient + b.gradient};
  }
  friend WithGradient operator-(const WithGradient& a, const WithGradient& b) {
    return {a.value - b.value, a.gradient - b.gradient};
  }
  friend WithGradient operator-(const WithGradient& a) { return {-a.value, -a.gradient}; }
  WithGradient& operator+=(const WithGradient& b) { return *this = *this + b; }
  WithGradient& operator-=(const WithGradient& b) { return *this = *this - b; }
  friend WithGradient operator*(const WithGradient& a, const WithGradient& b) {
    return {a.value * b.value, b.value * a.gradient + a.value * b.gradient};
  }
  friend WithGradient operator+(const WithGradient& a, double b) {
    return {a.value + b, a.gradient};
  }
  friend WithGradient operator+(double a, const WithGradient& b) { return b + a; }
  friend WithGradient operator-(const WithGradient& a, double b) {
    return {a.value - b, a.gradient};
  }
  friend WithGradient operator-(double a, const WithGradient& b) {
    return {a - b.value, -b.gradient};
  }
  friend WithGradient operator*(const WithGradient& a, double b) {
    return {a.value * b, a.gradient * b};
  }
  friend WithGradient operator*(double a, const WithGradient& b) { return b * a; }
  friend WithGradient operator/(const WithGradient& a, double b) {
    return {a.value / b, a.gradient / b};
  }

  friend WithGradient operator/(const WithGradient& a, const WithGradient& b) {
    const double quotient = a.value / b.value;
    return {quotient, (a.gradient - quotient * b.gradient) / b.value};
  }

  // Compares values. A choice has the derivatives of the chosen number.
  friend bool exceeds(const WithGradient& a, const WithGradient& b) { return a.value > b.value; }
  friend WithGradient choose(bool which, const WithGradient& yes, const WithGradient& no) {
    return which ? yes : no;
  }
  // Keeps the derivatives of `a`, because those of rounding are useless (0 almost everywhere).
  friend WithGradient nearest_integer(const WithGradient& a) {
    return {bbsim::nearest_integer(a.value), a.gradient};
  }

  friend WithGradient sin(const WithGradient& a) {
    return {std::sin(a.value), std::cos(a.value) * a.gradient};
  }
  friend WithGradient root_along(const WithGradient& square, const WithGradient& along) {
    const double root = std::copysign(std::sqrt(square.value), along.value);
    return {root, square.gradient / (2 * root)};
  }
  friend WithGradient cos(const WithGradient& a) {
    return {std::cos(a.value), -std::sin(a.value) * a.gradient};
  }
};

template <int n>
[[nodiscard]] double value_of(const WithGradient<n>& a) {
  return a.value;
}

// The plain time, which selects the interval of a table.
template <int n>
[[nodiscard]] double plain(const WithGradient<n>& t) {
  return t.value;
}

// The derivatives with respect to variables first ... first + count - 1, one row per number.
template <int rows, int n>
[[nodiscard]] Eigen::MatrixXd gradients(const WithGradient<n> (&of)[rows], int first, int count) {
  Eigen::MatrixXd found(rows, count);
  for (int i = 0; i < rows; ++i) found.row(i) = of[i].gradient.segment(first, count).transpose();
  return found;
}

template <int rows, int n>
[[nodiscard]] Eigen::VectorXd values(const WithGradient<n> (&of)[rows]) {
  Eigen::VectorXd found(rows);
  for (int i = 0; i < rows; ++i) found[i] = of[i].value;
  return found;
}

}  // namespace bbsim::simd
