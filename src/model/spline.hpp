// A C2 cubic interpolant through tabulated values.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace bbsim::model {

// Value, first and second derivative with respect to time.
template <class Real>
struct Jet {
  Real value, rate, acceleration;
};

// The time as a plain double, to choose an interval by. Overloaded for other number types.
[[nodiscard]] inline double plain(double t) {
  return t;
}

// A look at a Spline's pieces, without owning them.
struct SplineView {
  struct Piece {
    double start, c0, c1, c2, c3;  // of the powers of t - start
  };
  const Piece* pieces;
  std::size_t count;

  // Outside the table the end pieces go on.
  template <class Time>
  [[nodiscard]] Jet<Time> at(const Time& t) const {
    const Piece& p = pieces[interval(t)];
    const Time s = t - p.start;
    return {p.c0 + s * (p.c1 + s * (p.c2 + s * p.c3)), p.c1 + s * (2 * p.c2 + s * (3 * p.c3)),
            2 * p.c2 + s * (6 * p.c3)};
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

// Cubic spline with not-a-knot ends (de Boor, A Practical Guide to Splines, IV): it reproduces
// cubics, and its second derivative, the gimbal's acceleration, is continuous.
class Spline {
 public:
  // `times` strictly increasing, as many as `values`, at least four.
  Spline(std::vector<double> times, const std::vector<double>& values);

  template <class Time>
  [[nodiscard]] Jet<Time> at(const Time& t) const {
    return view().at(t);
  }

  // Valid as long as this spline or a copy of it lives.
  [[nodiscard]] SplineView view() const { return {pieces_->data(), pieces_->size()}; }

  // Where the third derivative jumps.
  [[nodiscard]] const std::vector<double>& knots() const { return times_; }

 private:
  using Piece = SplineView::Piece;

  std::vector<double> times_;
  std::shared_ptr<const std::vector<Piece>> pieces_;  // shared by copies: views stay valid
};

}  // namespace bbsim::model
