// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Piecewise polynomials of time: interpolants through tabulated values, and paths past waypoints.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "base/real.hpp"

namespace bbsim::model {

// Value, first and second derivative with respect to time.
template <class Real>
struct Jet {
  Real value, rate, acceleration;
};

// A look at a Spline's pieces, without owning them.
struct SplineView {
  struct Piece {
    double start, c0, c1 = 0, c2 = 0, c3 = 0, c4 = 0, c5 = 0;  // of the powers of t - start
  };
  const Piece* pieces;
  std::size_t count;

  // Outside the knots the end pieces go on.
  template <class Time>
  [[nodiscard]] Jet<Time> at(const Time& t) const {
    const Piece& p = pieces[interval(t)];
    const Time s = t - p.start;
    return {p.c0 + s * (p.c1 + s * (p.c2 + s * (p.c3 + s * (p.c4 + s * p.c5)))),
            p.c1 + s * (2 * p.c2 + s * (3 * p.c3 + s * (4 * p.c4 + s * (5 * p.c5)))),
            2 * p.c2 + s * (6 * p.c3 + s * (12 * p.c4 + s * (20 * p.c5)))};
  }

 private:
  // The last piece that starts at or before t, or the first.
  template <class Time>
  [[nodiscard]] std::size_t interval(const Time& t) const {
    const double when = plain(t);
    std::size_t low = 0;
    for (std::size_t high = count; high - low > 1;) {
      const std::size_t middle = (low + high) / 2;
      (when < pieces[middle].start ? high : low) = middle;
    }
    return low;
  }
};

// Pieces of degree 3 or 5 between knots, at which some derivative jumps.
class Spline {
 public:
  // Cubic spline with not-a-knot ends (de Boor, A Practical Guide to Splines, IV): it reproduces
  // cubics, and its second derivative, the gimbal's acceleration, is continuous.
  // `times` strictly increasing, as many as `values`, at least four.
  Spline(const std::vector<double>& times, const std::vector<double>& values);

  // Cubic spline that starts and ends at rest, and holds the end values outside the knots: its
  // second derivative is continuous but for the first and last knot.
  // `times` strictly increasing, as many as `values`, at least two.
  [[nodiscard]] static Spline at_rest_at_ends(std::vector<double> times,
                                              const std::vector<double>& values);

  // A spline that is at rest at every knot, and holds the end values outside: quintics of least
  // jerk (Flash and Hogan, 1985), each without speed and acceleration at both its ends.
  // `times` and `values` as above.
  [[nodiscard]] static Spline at_rest_at_knots(std::vector<double> times,
                                               const std::vector<double>& values);

  template <class Time>
  [[nodiscard]] Jet<Time> at(const Time& t) const {
    return view().at(t);
  }

  // Valid as long as this spline or a copy of it lives.
  [[nodiscard]] SplineView view() const { return {pieces_->data(), pieces_->size()}; }

  // The times at which the highest derivative jumps.
  [[nodiscard]] const std::vector<double>& knots() const { return times_; }

 private:
  using Piece = SplineView::Piece;

  Spline(std::vector<double> times, std::vector<Piece> pieces)
      : times_(std::move(times)),
        pieces_(std::make_shared<const std::vector<Piece>>(std::move(pieces))) {}

  std::vector<double> times_;
  std::shared_ptr<const std::vector<Piece>> pieces_;  // shared by copies: views stay valid
};

}  // namespace bbsim::model
