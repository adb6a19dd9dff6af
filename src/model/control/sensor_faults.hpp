// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Faults of a sensor that last: readings that stay the same, and frames that arrive together.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>

#include "base/instant.hpp"
#include "base/noise.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::model {

// A fault that begins by chance at a reading, and then lasts.
class LastingFault {
 public:
  LastingFault(const SensorFault& fault, std::uint64_t seed) : fault_(fault), chance_(seed) {}

  // Whether the fault is on at t, s; calls come in the order of time. Draws at each call, so that
  // faults do not move the draws of later readings. `begins` tells whether it begins at t.
  [[nodiscard]] bool is_on(double t, bool& begins) {
    const bool starts = chance_.uniform() < fault_.probability;
    const double now = t + rounding_of(t);  // a fault of whole periods ends at a reading
    begins = starts && !(now < until_);
    if (begins) until_ = t + fault_.duration;
    return now < until_;
  }
  [[nodiscard]] double until() const { return until_; }

 private:
  SensorFault fault_;
  Noise chance_;
  double until_ = -std::numeric_limits<double>::infinity();  // s
};

class SensorFaults {
 public:
  explicit SensorFaults(const Sensor& sensor) {
    // The seed of noise and dropouts (sampled_controller.cpp), but other sequences.
    if (sensor.stuck) stuck_.emplace(*sensor.stuck, sensor.seed + 0xbb67ae8584caa73bU);
    if (sensor.burst) burst_.emplace(*sensor.burst, sensor.seed + 0xa54ff53a5f1d36f1U);
  }

  // Replaces a reading at t by the one at which the sensor stuck.
  template <class Reading>
  void stick(double t, Reading& reading) {
    if (!stuck_) return;
    bool begins = false;
    if (!stuck_->is_on(t, begins)) return;
    if (begins) {
      position_ = reading.position;
      sees_ = reading.sees;
    }
    reading.position = position_;
    reading.sees = sees_;
  }
  // When a frame arrives that would arrive at t, s.
  [[nodiscard]] double arrival(double t) {
    bool begins = false;
    return burst_ && burst_->is_on(t, begins) ? burst_->until() : t;
  }

 private:
  std::optional<LastingFault> stuck_, burst_;
  Pair position_{};  // of the reading at which the sensor stuck, m
  bool sees_ = false;
};

}  // namespace bbsim::model
