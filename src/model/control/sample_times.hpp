// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// When a sampled controller samples: every period, or as its clock jitters.
#pragma once

#include <cmath>
#include <cstddef>
#include <deque>

#include "base/noise.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::model {

class SampleTimes {
 public:
  // `seed` is that of the sensor's noise, of which this one's is another sequence.
  SampleTimes(const Sampling& sampling, unsigned long seed);

  // The time of the n-th sample, s, n = 0, 1, ...: of none before those that have been forgotten.
  [[nodiscard]] double at(double n);

  // Whether it is known without being drawn, as those are that have been asked for.
  [[nodiscard]] bool knows(double n) const {
    return n >= first_ && n < first_ + static_cast<double>(times_.size());
  }

  // Nobody asks for samples before the n-th any more.
  void forget_before(double n);

  // How far they are drawn (base/archive.hpp).
  template <class Archive>
  void archive(Archive& archive) {
    archive(noise_, times_, first_);
    bool ascend = !times_.empty();
    for (std::size_t i = 0; i < times_.size(); ++i) {
      ascend = ascend && std::isfinite(times_[i]) && (i == 0 || times_[i] > times_[i - 1]);
    }
    archive.require(ascend && first_ >= 0 && first_ == std::floor(first_));
  }

 private:
  Sampling sampling_;
  Noise noise_;
  std::deque<double> times_{0.0};  // from the `first_` sample on; of a clock that jitters
  double first_ = 0;
};

}  // namespace bbsim::model
