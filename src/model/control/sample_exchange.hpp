// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The exchange between a rig and its sampled controller: measurements of the ball and commands,
// both with their delays.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include "base/instant.hpp"
#include "base/noise.hpp"
#include "base/queue.hpp"
#include "model/control/sample_times.hpp"
#include "model/control/sampled_controller.hpp"
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

// Keeps three clocks with numbered instants: exposures, for a sample or of a camera's frame;
// samples; and arrivals of commands.
class SampleExchange {
 public:
  explicit SampleExchange(const SampledLoop& loop);

  // Times of the next instant of any clock, of the next arrival of a command, and of the next
  // sample, s.
  [[nodiscard]] double next() const { return std::min({expose_.next, sample_.next, apply_.next}); }
  [[nodiscard]] double next_command() const { return apply_.next; }
  [[nodiscard]] double next_sample() const { return sample_.next; }

  // Times closer to t than this (s) equal t up to rounding: that of t + delay, the time of the
  // sample for which the sensor measures at t.
  [[nodiscard]] double rounding(double t) const { return rounding_of(t + sensor_delay_); }
  // End of the instant t: times up to it count as t, and nothing runs between them.
  [[nodiscard]] double instant_end(double t) const {
    return t + std::max(rounding(t), one_instant_);
  }

  // Whether an exposure, a sample or a command is due by `now`, and the actions then.
  [[nodiscard]] bool exposes_by(double now) const { return expose_.next <= now; }
  // The ball's position, m, and whether its contact force is enough for a touch screen.
  void expose(double x, double y, bool firm);
  [[nodiscard]] bool samples_by(double now) const { return sample_.next <= now; }
  [[nodiscard]] double sample_number() const { return sample_.number; }
  // Numbers of the next exposure, sample and command.
  struct Numbers {
    double exposure, sample, command;
  };
  [[nodiscard]] Numbers numbers() const { return {expose_.number, sample_.number, apply_.number}; }
  // The time of a sample, s. With jitter, not of samples that have been forgotten.
  [[nodiscard]] double time_of(double sample) {
    return (even_ ? sample * period_ : times_.at(sample)) - since_;
  }
  // The sensor's reading for the sample: of its exposure, or of the last frame that has arrived by
  // `now`. Empty if the sensor missed the ball.
  [[nodiscard]] std::optional<Pair> reading(double now) {
    if (!frames_) return seen_.front().what();
    while (!seen_.empty() && seen_.front().arrives <= now) frame_ = seen_.pop().what();
    return frame_;
  }
  // The same, and goes on to the next sample.
  std::optional<Pair> begin_sample(double now) {
    const std::optional<Pair> read = reading(now);
    if (!frames_) seen_.pop();
    go_on(sample_);
    return read;
  }
  // The commands for phi and theta, or for three servos.
  void end_sample(const std::array<double, most_servos>& commands) { commands_.push() = commands; }
  [[nodiscard]] bool commands_by(double now) const { return apply_.next <= now; }
  [[nodiscard]] std::array<double, most_servos> take_command() {
    go_on(apply_);
    if (!even_) forget_times();
    return commands_.pop();
  }

 private:
  // A recurring instant: `shift` after the sample or frame of that number.
  struct Clock {
    double shift;
    double number = -1;
    double next = 0;  // s
  };
  struct Seen {
    double arrives = 0;  // s
    Pair position{};
    bool sees = false;

    [[nodiscard]] std::optional<Pair> what() const {
      return sees ? std::optional(position) : std::nullopt;
    }
  };

  void go_on(Clock& clock) {
    ++clock.number;
    clock.next = time_of(clock.number) + clock.shift;
  }
  void go_on_exposing();
  void skip_past();
  void forget_times();

  // Members used at every instant are together.
  bool even_;
  double period_, since_, sensor_delay_, one_instant_;
  Clock expose_, sample_, apply_;
  std::optional<double> frames_;                     // period of a camera's frames, s
  Queue<Seen> seen_;                                 // exposed, not yet sampled
  std::optional<Pair> frame_;                        // the last one that has arrived
  Queue<std::array<double, most_servos>> commands_;  // computed, not yet applied
  BallSensor sensor_;
  SampleTimes times_;
  std::optional<SensorFaults> faults_;
};

}  // namespace bbsim::model
