// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Polynomials through values at Chebyshev points.
#pragma once

#include <cstddef>
#include <vector>

namespace bbsim {

// The Chebyshev points from 0 to 1, ends included, and the polynomial through values there, by the
// barycentric formula (Berrut and Trefethen, SIAM Review 46:501, 2004). Of a smooth function it is
// as good as any of its degree, to a factor; points lie closer towards the ends.
class ChebyshevPoints {
 public:
  explicit ChebyshevPoints(std::size_t intervals);  // at least 2

  [[nodiscard]] std::size_t size() const { return points_.size(); }
  [[nodiscard]] double operator[](std::size_t i) const { return points_[i]; }

  // The polynomial at s, 0 <= s <= 1.
  [[nodiscard]] double at(const double* values, double s) const;
  // Its derivative at 0 and at 1.
  [[nodiscard]] double slope_at_start(const double* values) const;
  [[nodiscard]] double slope_at_end(const double* values) const;
  // Its derivative at all points, size() numbers.
  void slopes(const double* values, double* into) const;
  // The polynomial between points i and i + 1: at the point between them of twice as many
  // intervals.
  [[nodiscard]] double between(const double* values, std::size_t i) const;
  // How far beyond its values at the points the polynomial may go, as a part of their range:
  // (L - 1) / 2 of the Lebesgue constant L <= 1 + 2 / pi log(n + 1) of n intervals.
  [[nodiscard]] double overshoot() const;
  // The sizes of its last two Chebyshev coefficients, added: what more points would change is of
  // this size, unless it is all of the function.
  [[nodiscard]] double tail(const double* values) const;

 private:
  std::vector<double> points_, weights_, start_slope_;
  std::vector<double> between_;  // for each interval, what each value adds between its points
};

// One for each number of intervals, made when it is first asked for.
class ChebyshevTables {
 public:
  // At least 2 intervals, and not very many. Valid as long as this object lives.
  [[nodiscard]] const ChebyshevPoints& points(std::size_t intervals);

 private:
  std::vector<std::vector<ChebyshevPoints>> of_;  // none or one, by intervals
};

}  // namespace bbsim
