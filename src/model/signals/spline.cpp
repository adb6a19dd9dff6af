// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/signals/spline.hpp"

#include <cmath>

#include "base/instant.hpp"

namespace bbsim::model {
namespace {

using Piece = SplineView::Piece;
using Numbers = std::vector<double>;

// Lengths and slopes between the knots.
struct Intervals {
  Numbers length, slope;

  Intervals(const Numbers& times, const Numbers& values)
      : length(times.size() - 1), slope(times.size() - 1) {
    for (std::size_t i = 0; i < length.size(); ++i) {
      length[i] = times[i + 1] - times[i];
      slope[i] = (values[i + 1] - values[i]) / length[i];
    }
  }
};

// A tridiagonal system. solve() uses its rows `first` to `last`.
struct Tridiagonal {
  Numbers lower, diagonal, upper, right;

  explicit Tridiagonal(std::size_t size) : lower(size), diagonal(size), upper(size), right(size) {}

  // Elimination without pivoting: a spline's system is diagonally dominant.
  void solve(std::size_t first, std::size_t last, Numbers& m) {
    for (std::size_t i = first + 1; i <= last; ++i) {
      const double factor = lower[i] / diagonal[i - 1];
      diagonal[i] -= factor * upper[i - 1];
      right[i] -= factor * right[i - 1];
    }
    m[last] = right[last] / diagonal[last];
    for (std::size_t i = last; i > first; --i) {
      m[i - 1] = (right[i - 1] - upper[i - 1] * m[i]) / diagonal[i - 1];
    }
  }
};

// The equations for the second derivatives m that make the first derivative continuous at inner
// knots.
Tridiagonal inner_rows(const Intervals& of) {
  const Numbers& h = of.length;
  Tridiagonal rows(h.size() + 1);
  for (std::size_t i = 1; i < h.size(); ++i) {
    rows.lower[i] = h[i - 1];
    rows.diagonal[i] = 2 * (h[i - 1] + h[i]);
    rows.upper[i] = h[i];
    rows.right[i] = 6 * (of.slope[i] - of.slope[i - 1]);
  }
  return rows;
}

std::vector<Piece> cubics(const Numbers& times, const Numbers& values, const Intervals& of,
                          const Numbers& m) {
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i < of.length.size(); ++i) {
    const double h = of.length[i];
    pieces.push_back({times[i], values[i], of.slope[i] - h * (2 * m[i] + m[i + 1]) / 6, m[i] / 2,
                      (m[i + 1] - m[i]) / (6 * h)});
  }
  return pieces;
}

std::vector<Piece> not_a_knot(const Numbers& times, const Numbers& values) {
  const std::size_t last = times.size() - 1;
  const Intervals of(times, values);
  const Numbers& h = of.length;
  // The not-a-knot conditions eliminate m[0] and m[last] from the first and last rows.
  Tridiagonal rows = inner_rows(of);
  const double first_ratio = h[0] / h[1];
  const double last_ratio = h[last - 1] / h[last - 2];
  rows.diagonal[1] += h[0] * (1 + first_ratio);
  rows.upper[1] -= h[0] * first_ratio;
  rows.diagonal[last - 1] += h[last - 1] * (1 + last_ratio);
  rows.lower[last - 1] -= h[last - 1] * last_ratio;
  Numbers m(last + 1);
  rows.solve(1, last - 1, m);
  m[0] = (1 + first_ratio) * m[1] - first_ratio * m[2];
  m[last] = (1 + last_ratio) * m[last - 1] - last_ratio * m[last - 2];
  return cubics(times, values, of, m);
}

// Adds pieces that hold the first value before the first knot and the last value after the last
// knot.
std::vector<Piece> held(std::vector<Piece> pieces, const Numbers& times, const Numbers& values) {
  pieces.insert(pieces.begin(), Piece{times.front(), values.front()});
  pieces.push_back({times.back(), values.back()});
  return pieces;
}

}  // namespace

Spline::Spline(const std::vector<double>& times, const std::vector<double>& values)
    : Spline(std::isinf(times.front()) ? held_outside(times, values)
                                       : Spline(times, not_a_knot(times, values))) {}

Spline Spline::held_outside(const std::vector<double>& times, const std::vector<double>& values) {
  Numbers inner_times(times.begin() + 1, times.end() - 1);
  const Numbers inner_values(values.begin() + 1, values.end() - 1);
  std::vector<Piece> pieces =
      held(not_a_knot(inner_times, inner_values), inner_times, inner_values);
  return {std::move(inner_times), std::move(pieces)};
}

Spline Spline::at_rest_at_ends(std::vector<double> times, const std::vector<double>& values) {
  const std::size_t last = times.size() - 1;
  const Intervals of(times, values);
  Tridiagonal rows = inner_rows(of);
  rows.diagonal[0] = 2 * of.length[0];
  rows.upper[0] = of.length[0];
  rows.right[0] = 6 * of.slope[0];
  rows.lower[last] = of.length[last - 1];
  rows.diagonal[last] = 2 * of.length[last - 1];
  rows.right[last] = -6 * of.slope[last - 1];
  Numbers m(last + 1);
  rows.solve(0, last, m);
  std::vector<Piece> pieces = cubics(times, values, of, m);
  pieces.front().c1 = 0;  // exactly, without rounding
  pieces = held(std::move(pieces), times, values);
  return {std::move(times), std::move(pieces)};
}

Spline Spline::at_rest_at_knots(std::vector<double> times, const std::vector<double>& values) {
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i + 1 < times.size(); ++i) {
    const double h = times[i + 1] - times[i];
    const double c = (values[i + 1] - values[i]) / h / h / h;
    pieces.push_back({times[i], values[i], 0, 0, 10 * c, -15 * c / h, 6 * c / h / h});
  }
  pieces = held(std::move(pieces), times, values);
  return {std::move(times), std::move(pieces)};
}

Spline Spline::held_between_knots(std::vector<double> times, const std::vector<double>& values) {
  std::vector<Piece> pieces{Piece{times.front(), values.front()}};
  for (std::size_t i = 0; i < times.size(); ++i) {
    pieces.push_back({times[i] - rounding_of(times[i]), values[i + 1]});
  }
  Spline spline(std::move(times), std::move(pieces));
  spline.jumps_ = true;
  return spline;
}

}  // namespace bbsim::model
