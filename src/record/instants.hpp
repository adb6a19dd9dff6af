// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Measures of curves: step metrics, times of events on a curve, and values at these times; and root
// mean squares.
#pragma once

#include <cmath>
#include <cstddef>
#include <functional>

#include "record/curve.hpp"
#include "scenario/measures.hpp"

namespace bbsim::record {

// Returns the curve of a column.
using CurveOf = std::function<const Curve&(const scenario::Column&)>;

// The value of a measure; if it is NaN, `why` gives the reason in a few words.
struct Measured {
  double value;
  const char* why = nullptr;
};

// The value of a measure of kind step, when or find.
[[nodiscard]] Measured measured(const scenario::Measure& measure, const CurveOf& curve_of);

// Whether the measure is of kind step, when or find.
[[nodiscard]] inline bool is_of_curves(const scenario::Measure& measure) {
  using Kind = scenario::Measure::Kind;
  return measure.kind == Kind::step || measure.kind == Kind::when || measure.kind == Kind::find;
}

// A sum of squares that neither overflows nor vanishes unless its root does. Sums the squares of
// large and of small values separately, scaled by powers of two (Blue, ACM Transactions on
// Mathematical Software 4, 1978).
class SquareSum {
 public:
  void add(double value) {
    const double size = std::abs(value);
    double& sum = size > large ? of_large_ : size < small ? of_small_ : rest_;
    const double scaled = size > large   ? std::ldexp(value, -shift)
                          : size < small ? std::ldexp(value, shift)
                                         : value;
    sum += scaled * scaled;
  }

  // The root mean square of `count` values.
  [[nodiscard]] double root_mean(std::size_t count) const {
    const auto n = static_cast<double>(count);
    if (of_large_ > 0) {
      return std::ldexp(std::sqrt((of_large_ + std::ldexp(rest_, -2 * shift)) / n), shift);
    }
    if (rest_ > 0) return std::sqrt((rest_ + std::ldexp(of_small_, -2 * shift)) / n);
    return std::ldexp(std::sqrt(of_small_ / n), -shift);
  }

 private:
  // A billion squares of values between these bounds stay within the range of doubles.
  static constexpr double large = 1e140, small = 1e-140;
  static constexpr int shift = 540;
  double of_large_ = 0, rest_ = 0, of_small_ = 0;
};

}  // namespace bbsim::record
