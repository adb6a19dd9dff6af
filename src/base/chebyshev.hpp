// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Interpolation by polynomials through values at Chebyshev points.
#pragma once

#include <cstddef>
#include <vector>

namespace bbsim {

// The Chebyshev points on [0, 1], ends included, and the polynomial through values at them, by the
// barycentric formula (Berrut and Trefethen, SIAM Review 46:501, 2004). For a smooth function the
// error is within a small factor of that of the best polynomial of this degree. The points are
// denser near the ends.
class ChebyshevPoints {
 public:
  explicit ChebyshevPoints(std::size_t intervals);  // at least 2

  [[nodiscard]] std::size_t size() const { return points_.size(); }
  [[nodiscard]] double operator[](std::size_t i) const { return points_[i]; }

  // The polynomial at s, 0 <= s <= 1. `values` has size() entries here and below.
  [[nodiscard]] double at(const double* values, double s) const;
  // Its derivative at 0 and at 1.
  [[nodiscard]] double slope_at_start(const double* values) const;
  [[nodiscard]] double slope_at_end(const double* values) const;
  // The derivative at all points. `into` has room for size() numbers.
  void slopes(const double* values, double* into) const;
  // The polynomial between points i and i + 1, at the Chebyshev point that lies there when the
  // number of intervals is doubled.
  [[nodiscard]] double between(const double* values, std::size_t i) const;
  // How far the polynomial may go beyond its values at the points, as a fraction of their range:
  // (L - 1) / 2 with the Lebesgue constant L <= 1 + 2 / pi log(n + 1) for n intervals.
  [[nodiscard]] double overshoot() const;
  // The sum of the absolute values of the last two Chebyshev coefficients. It estimates how much
  // more points would change the polynomial, if the coefficients decay.
  [[nodiscard]] double tail(const double* values) const;

 private:
  std::vector<double> points_, weights_, start_slope_;
  std::vector<double> between_;  // [i * size() + k]: weight of value k between points i and i + 1
};

// ChebyshevPoints for each number of intervals, made on first use.
class ChebyshevTables {
 public:
  // `intervals` is at least 2 and should be small. The reference is valid as long as this object.
  [[nodiscard]] const ChebyshevPoints& points(std::size_t intervals);

 private:
  std::vector<std::vector<ChebyshevPoints>> of_;  // by number of intervals; empty or one entry
};

}  // namespace bbsim
