// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Detects steps that shrink on the way to an instant beyond which there is no motion.
#pragma once

#include <algorithm>

#include "solve/collocation/step_length.hpp"
#include "solve/outcome.hpp"

namespace bbsim::solve {

class Shrinking {
 public:
  // The failure of a run that diverges().
  static constexpr Failure reason{Why::unbounded, "the motion grows without bound"};

  // Call it if the next step cannot be compared with the last one.
  void interrupt() { last_ = 0; }

  // Takes a step (s) from time t (s) that is about to be accepted. Returns whether the motion goes
  // to infinity in finite time: a dozen steps have shrunk since one grew by a quarter, the last is
  // below 1e-5 of that one and of t, and the states have grown meanwhile. A smooth motion that
  // passes an obstacle does not shrink its steps like this. With a tolerance below the rounding
  // errors they may shrink, but the states do not grow, and the run continues. size() is the
  // magnitude of the largest state at t, infinite if a state is not finite.
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

  // The number of shorter steps since the last step that was longer by a quarter.
  [[nodiscard]] int count() const { return count_; }

  // Call it after each accepted step. `error`: its error relative to the tolerance. `next`: the
  // next step by this error alone, s. Returns the longest next step, s. Where steps shrink, the
  // error grows from step to step by more than the step lengths explain, and will again. Predicting
  // this growth saves rejections (Gustafsson's predictive control; Hairer and Wanner, IV.8). The
  // bound needs two shorter steps in a row. With Sign::jump, one is enough if its error is far
  // above the last one.
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

 private:
  // The number of shorter steps since the last longer one, and how many of them are consecutive at
  // present.
  int count_ = 0, in_a_row_ = 0;
  // The step before count_ began, the last step, and its ratio to the one before.
  double from_ = 0, last_ = 0, ratio_ = 1;
  double size_before_ = 0;  // when count_ reached four
  double last_error_ = 1;
};

}  // namespace bbsim::solve
