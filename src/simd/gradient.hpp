// Dual numbers: a value with its gradient, for exact derivatives by forward differentiation.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace bbsim::simd {

// A function's value and its partial derivatives with respect to n variables.
//
// Every operation is evaluated at once. Eigen's AutoDiffScalar builds one expression of the whole
// right-hand side instead, which takes a compiler with sanitizers seven minutes for our systems.
template <int n>
struct Dual {
  using Gradient = Eigen::Matrix<double, n, 1>;
  double value = 0;
  Gradient gradient = Gradient::Zero();

  Dual() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): a constant is a number like any other
  Dual(double constant) : value(constant) {}
  Dual(double v, const Gradient& g) : value(v), gradient(g) {}

  // The variable number i.
  static Dual variable(double v, int i) { return {v, Gradient::Unit(i)}; }

  friend Dual operator+(const Dual& a, const Dual& b) {
    return {a.value + b.value, a.gradient + b.gradient};
  }
  friend Dual operator-(const Dual& a, const Dual& b) {
    return {a.value - b.value, a.gradient - b.gradient};
  }
  friend Dual operator-(const Dual& a) { return {-a.value, -a.gradient}; }
  friend Dual operator*(const Dual& a, const Dual& b) {
    return {a.value * b.value, b.value * a.gradient + a.value * b.gradient};
  }
  friend Dual operator+(const Dual& a, double b) { return {a.value + b, a.gradient}; }
  friend Dual operator+(double a, const Dual& b) { return b + a; }
  friend Dual operator-(const Dual& a, double b) { return {a.value - b, a.gradient}; }
  friend Dual operator-(double a, const Dual& b) { return {a - b.value, -b.gradient}; }
  friend Dual operator*(const Dual& a, double b) { return {a.value * b, a.gradient * b}; }
  friend Dual operator*(double a, const Dual& b) { return b * a; }
  friend Dual operator/(const Dual& a, double b) { return {a.value / b, a.gradient / b}; }

  friend Dual operator/(const Dual& a, const Dual& b) {
    const double quotient = a.value / b.value;
    return {quotient, (a.gradient - quotient * b.gradient) / b.value};
  }

  friend Dual sin(const Dual& a) { return {std::sin(a.value), std::cos(a.value) * a.gradient}; }
  friend Dual cos(const Dual& a) { return {std::cos(a.value), -std::sin(a.value) * a.gradient}; }
};

}  // namespace bbsim::simd
