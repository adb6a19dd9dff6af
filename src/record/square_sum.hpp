// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A sum of squares that neither overflows nor vanishes unless its root does.
#pragma once

#include <cmath>
#include <cstddef>

namespace bbsim::record {

// Sums the squares of large and of small values separately, scaled by powers of two (Blue, ACM
// Transactions on Mathematical Software 4, 1978).
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
