// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Interpolation through values at Chebyshev points, the maxima of a smooth function from such
// values, and zeros.
#pragma once

#include <algorithm>
#include <cmath>
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

struct Peak {
  double at = 0, value = 0;
};

// The precision of a maximum's place, as a fraction of the bracket. Near a maximum, the value's
// error is quadratic in the place's error, so 1e-7 suffices for a value good to about 1e-14.
inline constexpr double good_place = 1e-7;

// An interval that may contain a maximum. `best` is at least as high as its neighbors `from` and
// `to`; at an end of the range, it is one of them. The search starts at `guess`.
struct Bracket {
  Peak from, best, to;
  double guess = 0;
};

// The parabola through three points, the middle one the highest: its slope there, and minus half
// its second derivative.
struct Parabola {
  double slope, bend;

  [[nodiscard]] static Parabola through(const Peak& from, const Peak& best, const Peak& to) {
    const double before = best.at - from.at, after = to.at - best.at;
    const double rise = (best.value - from.value) / before, fall = (best.value - to.value) / after;
    return {(rise * after - fall * before) / (before + after), (rise + fall) / (before + after)};
  }
};

// A bracket within the range, to start at the top of the parabola through its three points.
[[nodiscard]] inline Bracket within(const Peak& from, const Peak& best, const Peak& to) {
  const auto [slope, bend] = Parabola::through(from, best, to);
  return {from, best, to, best.at + (bend > 0 ? slope / (2 * bend) : (to.at - best.at) / 2)};
}

// The zero of a function by bisection, to rounding. It has different signs at both ends.
template <class Function>
[[nodiscard]] double zero_between(double low, double high, Function function) {
  const double rising = function(low) < 0 ? 1 : -1;
  for (;;) {
    const double middle = low + (high - low) / 2;
    if (middle <= low || middle >= high) return middle;
    (rising * function(middle) < 0 ? low : high) = middle;
  }
}

// The assumption about the function between points. Smooth: it exceeds the values by about as much
// as the parabola through three of them. Kinks (a distance has one at 0): each side may go on along
// its chord up to a corner.
enum class Between { smooth, kinks };

// Computes values at the points of twice as many intervals, for coarse points that may hide a
// maximum between them. A new value is the polynomial's where that may exceed `best`. Elsewhere it
// is the lower one of its two neighbors. If the maximum may lie at an end, all new values are the
// polynomial's, because for_each_bracket takes the slope at the end from all of them.
inline void refine(const ChebyshevPoints& points, const double* values, double best,
                   std::vector<double>& finer) {
  const std::size_t last = points.size() - 1;
  finer.resize(2 * last + 1);
  finer[2 * last] = values[last];
  const auto may_exceed = [&](std::size_t i) {
    const double here = values[i], next = values[i + 1];
    const double before = values[i == 0 ? i : i - 1], after = values[i + 1 == last ? last : i + 2];
    const double most = std::max({before, here, next, after});
    const double least = std::min({before, here, next, after});
    return most + (most - least) > best;
  };
  const bool at_end = may_exceed(0) || may_exceed(last - 1);
  for (std::size_t i = 0; i < last; ++i) {
    finer[2 * i] = values[i];
    finer[2 * i + 1] =
        at_end || may_exceed(i) ? points.between(values, i) : std::min(values[i], values[i + 1]);
  }
}

// Calls use(bracket) for each interval in which the function may exceed `best`. `use` may raise
// `best`. Values that are NaN are skipped.
template <class Use>
void for_each_bracket(const ChebyshevPoints& points, const double* values, const double& best,
                      Between between, Use use) {
  // Relative differences up to this may be rounding.
  constexpr double rounding = 1e-14;
  const auto promises = [&](double promise) { return promise > best + rounding * std::abs(best); };
  const std::size_t last = points.size() - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    const double here = values[i];
    if ((i > 0 && !(here >= values[i - 1])) || (i < last && !(here >= values[i + 1]))) continue;
    if (i > 0 && i < last) {
      const Peak from{points[i - 1], values[i - 1]}, peak{points[i], here};
      const Peak to{points[i + 1], values[i + 1]};
      const auto [slope, bend] = Parabola::through(from, peak, to);
      if (!(bend > 0)) continue;  // level
      const double before = peak.at - from.at, after = to.at - peak.at;
      const double more = between == Between::kinks ? std::max((here - from.value) / before * after,
                                                               (here - to.value) / after * before)
                                                    : slope * slope / (2 * bend);
      if (promises(here + more)) use(within(from, peak, to));
      continue;
    }
    // The maximum may lie at an end, or between the end and the next point.
    const std::size_t inner = i == 0 ? 1 : last - 1, next = i == 0 ? 2 : last - 2;
    const double width = std::abs(points[inner] - points[i]);
    const double change = here - values[inner];
    const Peak end{points[i], here}, neighbor{points[inner], values[inner]};
    const auto look_within = [&](double way) {
      use(Bracket{i == 0 ? end : neighbor, end, i == 0 ? neighbor : end,
                  points[i] + (i == 0 ? way : -way)});
    };
    if (between == Between::kinks) {
      // The chord of the next interval, continued up to a corner, bounds the function.
      const double chord = (values[inner] - values[next]) / std::abs(points[inner] - points[next]);
      if (promises(values[inner] + chord * width)) look_within(width / 2);
      continue;
    }
    // A maximum lies within if the slope at the end points inward. The slope takes all values;
    // this check takes three values and skips most ends that cannot hold a maximum above `best`.
    if (!promises(here + 4 * (change + std::abs(values[inner] - values[next])))) continue;
    const double slope = i == 0 ? points.slope_at_start(values) : -points.slope_at_end(values);
    if (!(slope > 0)) continue;
    const double way = slope / (2 * (slope + change / width)) * width;
    if (promises(here + slope * way)) look_within(way);
  }
}

// The maximum of the function within the bracket: parabolic steps, and golden sections where a
// parabola fails (Brent, Algorithms for Minimization without Derivatives, 1973, chapter 5). Stops
// when the place is known to `precision`, or when a further step would gain no more than rounding.
// If the bracket contains several maxima, it finds one of them.
template <class Function>
[[nodiscard]] Peak climb(const Bracket& bracket, double precision, Function function) {
  constexpr double golden = 0.3819660112501051;  // the smaller section
  constexpr double rounding = 1e-16;
  constexpr int most = 80;
  double low = bracket.from.at, high = bracket.to.at;
  const double width = high - low;
  const bool rises = bracket.to.value > bracket.from.value;
  Peak best = bracket.best;
  Peak second = rises ? bracket.to : bracket.from, third = rises ? bracket.from : bracket.to;
  double step = bracket.guess - best.at, before = width;
  for (int i = 0; i < most; ++i) {
    const double middle = (low + high) / 2;
    if (std::abs(best.at - middle) <= 2 * precision - (high - low) / 2) break;
    if (i > 0) {
      // The step to the top of the parabola, if it stays within the bracket and the steps shrink.
      const double r = (best.at - second.at) * (best.value - third.value);
      double q = (best.at - third.at) * (best.value - second.value);
      double p = (best.at - third.at) * q - (best.at - second.at) * r;
      q = 2 * (q - r);
      if (q > 0) p = -p;
      q = std::abs(q);
      const bool parabola = std::abs(before) > precision &&
                            std::abs(p) < std::abs(q * before / 2) && p > q * (low - best.at) &&
                            p < q * (high - best.at);
      before = step;
      if (parabola) {
        step = p / q;
        const double bend = ((second.value - best.value) / (second.at - best.at) -
                             (third.value - best.value) / (third.at - best.at)) /
                            (second.at - third.at);
        const bool near = std::max(std::abs(before), std::abs(step)) < 0.05 * width;
        if (near && -bend * step * step <= rounding * std::abs(best.value)) break;
        const double reached = best.at + step;
        if (reached - low < 2 * precision || high - reached < 2 * precision) {
          step = std::copysign(precision, middle - best.at);
        }
      } else {
        before = (best.at >= middle ? low : high) - best.at;
        step = golden * before;
      }
      if (std::abs(step) < precision) step = std::copysign(precision, step);
    }
    const Peak now{best.at + step, function(best.at + step)};
    if (now.value >= best.value) {
      (now.at >= best.at ? low : high) = best.at;
      third = second;
      second = best;
      best = now;
    } else {
      (now.at < best.at ? low : high) = now.at;
      if (now.value >= second.value || second.at == best.at) {
        third = second;
        second = now;
      } else if (now.value >= third.value || third.at == best.at || third.at == second.at) {
        third = now;
      }
    }
  }
  return best;
}

}  // namespace bbsim
