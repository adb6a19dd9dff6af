// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Times at which a controller samples: every period, or with the jitter of its clock; and the cycle
// after which the pattern of samples and camera frames repeats.
#pragma once

#include <deque>

#include "base/noise.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::model {

struct CommonCycle {
  double samples = 1, frames = 1;  // in a cycle: whole numbers
  // True without frames. False if frames and samples do not coincide again within 500 samples, or
  // if the samples' clock is uneven.
  bool known = true;
};

[[nodiscard]] CommonCycle common_cycle(const bbsim::Sampling& sampling, const Sensor& sensor);

// Instants of different clocks closer than this, relative to the sampling period, count as equal.
inline constexpr double one_instant = 1e-9;

class SampleTimes {
 public:
  // `seed` is that of the sensor's noise; jitter uses another sequence.
  SampleTimes(const Sampling& sampling, std::uint64_t seed);

  // The time of sample n = 0, 1, ..., s; not of samples that have been forgotten.
  [[nodiscard]] double at(double n);

  // Forgets the samples before the n-th.
  void forget_before(double n);

 private:
  Sampling sampling_;
  Noise noise_;
  std::deque<double> times_{0.0};  // from sample `first_` on, for an uneven clock
  double first_ = 0;
};

}  // namespace bbsim::model
