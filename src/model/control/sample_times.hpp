// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Times at which a controller samples: every period, or with the jitter of its clock.
#pragma once

#include <cmath>
#include <cstddef>
#include <deque>

#include "base/noise.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::model {

class SampleTimes {
 public:
  // `seed` is that of the sensor's noise; jitter uses another sequence.
  SampleTimes(const Sampling& sampling, std::uint64_t seed);

  // The time of sample n = 0, 1, ..., s; not of samples that have been forgotten.
  [[nodiscard]] double at(double n);

  // Whether the time is known without drawing it.
  [[nodiscard]] bool knows(double n) const {
    return n >= first_ && n < first_ + static_cast<double>(times_.size());
  }

  // Forgets the samples before the n-th.
  void forget_before(double n);

 private:
  Sampling sampling_;
  Noise noise_;
  std::deque<double> times_{0.0};  // from sample `first_` on, for an uneven clock
  double first_ = 0;
};

}  // namespace bbsim::model
