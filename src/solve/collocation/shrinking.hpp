// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// How steps shrink on the way to an instant beyond which there is no motion.
#pragma once

#include <algorithm>

#include "solve/collocation/step_length.hpp"
#include "solve/outcome.hpp"

namespace bbsim::solve {

class Shrinking {
 public:
  // Why a run ends there.
  static constexpr Failure reason{Why::unbounded, "the motion grows without bound"};

  // The next step has none before it that it can be compared with.
  void interrupt() { last_ = 0; }

  // Takes a step at time t that is about to be accepted, both in s. Whether steps shrink as they do
  // on the way to infinity in finite time, each to a part of what is left: for long, and by far,
  // while states grow. A smooth motion that passes something does not make a dozen steps ever
  // shorter, to a hundred thousandth, with none that is longer again by a quarter; one whose
  // tolerance is below what rounding lets it reach may, and goes on. size() is that of the greatest
  // state at t, infinite if one is no number.
  template <class Size>
  [[nodiscard]] bool diverges(double step, double t, Size size) {
    constexpr int for_a_while = 4, long_since = 12;
    constexpr double by_far = 1e-5, grown = 2, longer = 1.25;
    const bool shorter = step < 0.9 * last_;
    in_a_row_ = shorter ? in_a_row_ + 1 : 0;
    if (shorter) {
      if (++count_ == for_a_while) size_before_ = size();
    } else if (!(step < longer * last_)) {
      count_ = 0;
      from_ = step;
    }
    ratio_ = step / last_;
    last_ = step;
    return count_ >= long_since && step < by_far * std::min(from_, t) &&
           !(size() < grown * size_before_);
  }

  // How many steps were shorter than the one before, since one that was longer by a quarter.
  [[nodiscard]] int count() const { return count_; }

  // To be told the error of each step that was taken, in the tolerances' weights, and how long its
  // size alone would have the next one be, s: how long that may be. Where steps shrink, the error
  // has grown from step to step by more than their sizes say, and will again (Gustafsson's
  // predictive control; Hairer and Wanner, IV.8): rejections fewer. Two steps in a row show it;
  // with Sign::jump one does, if its error is far above the last one.
  enum class Sign { steps, jump };
  [[nodiscard]] double bound(double error, double next, int stages, Sign sign = Sign::steps) {
    constexpr double by_far = 10;
    const bool jumps = sign == Sign::jump && count_ >= 1 && error > by_far * last_error_;
    double most = next;
    if (jumps || (in_a_row_ >= 2 && error > 0)) {
      const double trend = step_growth(error / last_error_, stages) / step_growth(1.0, stages);
      most = std::min(next, next * ratio_ * trend);
    }
    last_error_ = std::max(error, 1e-3);
    return most;
  }

  // What it remembers (base/archive.hpp).
  template <class Archive>
  void archive(Archive& archive) {
    archive(count_, in_a_row_, from_, last_, ratio_, size_before_, last_error_);
    constexpr int most = 1 << 30;
    archive.require(count_ >= 0 && count_ < most && in_a_row_ >= 0 && in_a_row_ < most);
  }

 private:
  // Of steps that were shorter than the one before: since one that was longer, and of the last
  // ones.
  int count_ = 0, in_a_row_ = 0;
  // The step that the former count begins after, the last one, and its part of the one before.
  double from_ = 0, last_ = 0, ratio_ = 1;
  double size_before_ = 0;  // when steps had shrunk for a while
  double last_error_ = 1;
};

}  // namespace bbsim::solve
