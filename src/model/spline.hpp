// A C2 cubic interpolant through tabulated values.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace bbsim::model {

// Value, first and second derivative with respect to time.
template <class Real>
struct Jet {
  Real value, rate, acceleration;
};

// The time as a plain double, to choose an interval by. Overloaded for other number types.
[[nodiscard]] inline double plain(double t) { return t; }

// Cubic spline with not-a-knot ends (de Boor, A Practical Guide to Splines, IV): it reproduces
// cubics, and its second derivative, the gimbal's acceleration, is continuous.
class Spline {
 public:
  // `times` strictly increasing, as many as `values`, at least four.
  Spline(std::vector<double> times, const std::vector<double>& values);

  // Outside the table the end pieces go on.
  template <class Time>
  [[nodiscard]] Jet<Time> at(const Time& t) const {
    const Piece& p = pieces_[interval(plain(t))];
    const Time s = t - p.start;
    return {p.c0 + s * (p.c1 + s * (p.c2 + s * p.c3)), p.c1 + s * (2 * p.c2 + s * (3 * p.c3)),
            2 * p.c2 + s * (6 * p.c3)};
  }

  // Where the third derivative jumps.
  [[nodiscard]] const std::vector<double>& knots() const { return times_; }

 private:
  struct Piece {
    double start, c0, c1, c2, c3;
  };

  [[nodiscard]] std::size_t interval(double t) const {
    const auto next = std::upper_bound(times_.begin() + 1, times_.end() - 1, t);
    return static_cast<std::size_t>(next - times_.begin()) - 1;
  }

  std::vector<double> times_;
  std::vector<Piece> pieces_;
};

}  // namespace bbsim::model
