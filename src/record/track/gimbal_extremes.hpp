// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The greatest tilt and the greatest angular velocity of a plane whose motion is a given function
// of time.
#pragma once

#include <cstddef>
#include <vector>

#include "base/chebyshev.hpp"
#include "model/signals/signal_pair.hpp"
#include "record/track/kernels/track_kernels.hpp"
#include "record/track/padded_rows.hpp"
#include "record/track/signal_rows.hpp"
#include "record/track/spans.hpp"

namespace bbsim::record {

// The tilt (rad) that has this versine, 1 - cos(tilt).
[[nodiscard]] double tilt_of(double versine);

// The time after which a motion of the gimbal has shown all its tilts and rates, s. A sinusoid of
// both angles takes all of its values in one period, and in half of one if the plate is level on
// average. Infinite for all other motions.
[[nodiscard]] double repeats_after(const model::SignalView& motion);

class GimbalExtremes {
 public:
  GimbalExtremes();
  GimbalExtremes(const GimbalExtremes&) = delete;  // points_ refers to search_
  GimbalExtremes& operator=(const GimbalExtremes&) = delete;

  struct Greatest {
    double tilt = 0;  // rad
    double rate = 0;  // rad/s
  };
  // The greatest values over the times from 0 to `end` (s).
  [[nodiscard]] Greatest of(const model::SignalPair& motion, double end);

 private:
  void cover(const model::SignalPair& motion, double from, double to);
  void flush(const model::SignalPair& motion);

  const TrackKernels& kernels_;
  SpanSearch search_;
  const ChebyshevPoints& points_;
  std::vector<Span> spans_;  // not searched yet
  std::size_t count_ = 0;    // number of their points
  SignalRows angles_;        // at these points
  PaddedRows versine_, rate_squared_;
  double versine_most_ = 0, rate_squared_most_ = 0;
};

}  // namespace bbsim::record
