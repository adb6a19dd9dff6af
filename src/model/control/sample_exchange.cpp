// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/control/sample_exchange.hpp"

#include <cmath>

namespace bbsim::model {

SampleExchange::SampleExchange(const SampledLoop& loop)
    : even_(loop.sampling.is_even()),
      period_(loop.sampling.period),
      since_(loop.sampling.since),
      sensor_delay_(loop.sensor.delay),
      one_instant_(one_instant * period_),
      expose_{loop.sensor.period ? loop.sensor.phase : -sensor_delay_},
      sample_{0},
      apply_{loop.sampling.delay},
      frames_(loop.sensor.period),
      sensor_(loop.sensor),
      times_(loop.sampling, loop.sensor.seed) {
  if (loop.sensor.stuck || loop.sensor.burst) faults_.emplace(loop.sensor);
  // Start from the last frame that has arrived at t = 0, or the one before.
  if (frames_) expose_.number = std::floor((-sensor_delay_ - expose_.shift) / *frames_) - 2;
  if (since_ > 0) skip_past();
  go_on_exposing();
  go_on(sample_);
  go_on(apply_);
}

// Skips samples before t = 0 and their commands, up to the one in effect at t = 0.
void SampleExchange::skip_past() {
  while (time_of(apply_.number + 2) + apply_.shift <= one_instant_) ++apply_.number;
  while (time_of(sample_.number + 1) < -one_instant_) ++sample_.number;
  if (!frames_) expose_.number = sample_.number;
}

void SampleExchange::go_on_exposing() {
  if (!frames_) return go_on(expose_);
  ++expose_.number;
  expose_.next = expose_.number * *frames_ + expose_.shift;
}

void SampleExchange::expose(double x, double y, bool firm) {
  Seen& now = seen_.push();
  now.arrives = expose_.next + sensor_delay_;
  now.sees = sensor_.read(x, y, now.position, firm);
  if (faults_) {
    faults_->stick(expose_.next, now);
    now.arrives = faults_->arrival(now.arrives);
  }
  go_on_exposing();
}

// Forgets the times of samples that no clock needs any more.
void SampleExchange::forget_times() {
  const double last = std::min(sample_.number, apply_.number);
  times_.forget_before(frames_ ? last : std::min(last, expose_.number));
}

}  // namespace bbsim::model
