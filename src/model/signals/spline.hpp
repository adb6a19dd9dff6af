// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Piecewise polynomials in time: interpolants of tables, and paths through waypoints.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "base/real.hpp"

namespace bbsim::model {

// Value, first and second derivative with respect to time (s).
template <class Real>
struct Jet {
  Real value, rate, acceleration;
};

// A polynomial. Scalar is double, or a pack with one polynomial per lane.
template <class Scalar>
struct SplinePiece {
  // start, and the coefficients of powers of t - start.
  Scalar start, c0, c1 = 0, c2 = 0, c3 = 0, c4 = 0, c5 = 0;

  template <class Time>
  [[nodiscard]] Jet<Time> at(const Time& t) const {
    const Time s = t - start;
    return {c0 + s * (c1 + s * (c2 + s * (c3 + s * (c4 + s * c5)))),
            c1 + s * (2 * c2 + s * (3 * c3 + s * (4 * c4 + s * (5 * c5)))),
            2 * c2 + s * (6 * c3 + s * (12 * c4 + s * (20 * c5)))};
  }
};

// A view of a Spline's pieces.
struct SplineView {
  using Piece = SplinePiece<double>;
  const Piece* pieces;
  std::size_t count;

  // The end pieces continue outside the knots.
  template <class Time>
  [[nodiscard]] Jet<Time> at(const Time& t) const {
    return pieces[interval(t)].at(t);
  }

  // The last piece that starts at or before t, or else the first piece.
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

// Pieces of degree 0, 3 or 5 between knots. At a knot, a derivative jumps; for degree 0, the value
// itself.
class Spline {
 public:
  // Cubic spline with not-a-knot ends (de Boor, A Practical Guide to Splines, IV). It reproduces
  // cubics, and its second derivative, the gimbal's acceleration, is continuous. Needs strictly
  // increasing `times`, as many `values`, and at least four finite times. If the first and last
  // times are -infinity and infinity, it holds the end values of the finite times beyond them.
  Spline(const std::vector<double>& times, const std::vector<double>& values);

  // Cubic spline that starts and ends at rest and holds the end values outside the knots. Its
  // second derivative is continuous except at the first and last knot. Needs at least two strictly
  // increasing `times`, and as many `values`.
  [[nodiscard]] static Spline at_rest_at_ends(std::vector<double> times,
                                              const std::vector<double>& values);

  // Spline at rest at every knot, which holds the end values outside. Its pieces are the quintics
  // of least jerk (Flash and Hogan, 1985), with zero velocity and acceleration at both ends: (M14).
  // `times` and `values` as above.
  [[nodiscard]] static Spline at_rest_at_knots(std::vector<double> times,
                                               const std::vector<double>& values);

  // Holds values[i + 1] from times[i] on, and the first value before. At an instant that differs
  // from a time only by rounding, the value has jumped. Needs strictly increasing `times`, at
  // least one, and one more value than times.
  [[nodiscard]] static Spline held_between_knots(std::vector<double> times,
                                                 const std::vector<double>& values);

  template <class Time>
  [[nodiscard]] Jet<Time> at(const Time& t) const {
    return view().at(t);
  }

  // The view is valid while this spline or a copy exists.
  [[nodiscard]] SplineView view() const { return {pieces_->data(), pieces_->size()}; }

  // The times at which a derivative or the value jumps.
  [[nodiscard]] const std::vector<double>& knots() const { return times_; }
  // Whether the value jumps at the knots.
  [[nodiscard]] bool jumps() const { return jumps_; }

 private:
  using Piece = SplineView::Piece;

  static Spline held_outside(const std::vector<double>& times, const std::vector<double>& values);

  Spline(std::vector<double> times, std::vector<Piece> pieces)
      : times_(std::move(times)),
        pieces_(std::make_shared<const std::vector<Piece>>(std::move(pieces))) {}

  std::vector<double> times_;
  bool jumps_ = false;
  std::shared_ptr<const std::vector<Piece>> pieces_;  // copies share them, so views stay valid
};

}  // namespace bbsim::model
