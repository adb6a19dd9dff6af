// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What goes between a rig and its sampled controller, and when: what the sensor sees of the ball,
// and the controller's commands, either of them on its way for some time.
#pragma once

#include <algorithm>
#include <optional>

#include "base/archive.hpp"
#include "base/instant.hpp"
#include "base/queue.hpp"
#include "model/control/sample_times.hpp"
#include "model/control/sampled_controller.hpp"

namespace bbsim::model {

// Instants of its three clocks, each known by its number: exposures, of a sample or of a camera's
// frame; samples; and when a sample's command arrives. Each is asked for in turn.
class SampleExchange {
 public:
  explicit SampleExchange(const SampledLoop& loop);

  // The first instant that is left, the first one at which a command arrives, and the next sample,
  // s.
  [[nodiscard]] double next() const { return std::min({expose_.next, sample_.next, apply_.next}); }
  [[nodiscard]] double next_command() const { return apply_.next; }
  [[nodiscard]] double next_sample() const { return sample_.next; }

  // Times nearer to t than this (s) are one with it but for their rounding: what the sensor sees at
  // t is of the sample at t + delay.
  [[nodiscard]] double rounding(double t) const { return rounding_of(t + sensor_delay_); }
  // Until when instants are one with t: a run of no length between them is none.
  [[nodiscard]] double instant_end(double t) const {
    return t + std::max(rounding(t), one_instant_);
  }

  // Whether one is left up to `now`, which is due then; and what is to be done about it.
  [[nodiscard]] bool exposes_by(double now) const { return expose_.next <= now; }
  void expose(double x, double y);  // of a ball there, m
  [[nodiscard]] bool samples_by(double now) const { return sample_.next <= now; }
  [[nodiscard]] double sample_number() const { return sample_.number; }
  // Of the next exposure, sample and command.
  struct Numbers {
    double exposure, sample, command;
  };
  [[nodiscard]] Numbers numbers() const { return {expose_.number, sample_.number, apply_.number}; }
  // The time of a sample, s. Of a clock that jitters, none before the last one that is forgotten.
  [[nodiscard]] double time_of(double sample) {
    return (even_ ? sample * period_ : times_.at(sample)) - since_;
  }
  // What the sensor has to say at the sample: of the exposure for it, or the last frame that has
  // come by `now`; nothing if it missed the ball.
  [[nodiscard]] std::optional<Pair> begin_sample(double now) {
    go_on(sample_);
    if (!frames_) return seen_.pop().what();
    while (!seen_.empty() && seen_.front().at + sensor_delay_ <= now) frame_ = seen_.pop().what();
    return frame_;
  }
  void end_sample(double phi, double theta) { commands_.push() = {phi, theta}; }
  [[nodiscard]] bool commands_by(double now) const { return apply_.next <= now; }
  [[nodiscard]] Pair take_command() {
    go_on(apply_);
    if (!even_) forget_times();
    return commands_.pop();
  }
  // Of three servos, a third command goes with each of these.
  void push_third(double command) { thirds_.push() = command; }
  [[nodiscard]] double take_third() { return thirds_.pop(); }

  // What changes over a run (base/archive.hpp).
  template <class Archive>
  void archive(Archive& archive) {
    const double first_exposure = Archive::reads ? expose_.number : 0;
    archive(sensor_, times_, seen_, frame_, commands_);
    if (legs_) archive(thirds_);
    archive(expose_.number, sample_.number, apply_.number);
    if constexpr (Archive::reads) {
      archive.require(is_sound(first_exposure));
      if (frames_) {
        expose_.next = frame_time();
      } else {
        put(expose_);
      }
      put(sample_);
      put(apply_);
    }
  }

 private:
  // An instant that recurs: of the sample of that number, or of a frame, and so much later.
  struct Clock {
    double shift;
    double number = -1;
    double next = 0;  // s
  };
  struct Seen {
    double at = 0;  // when, of frames, s
    Pair position{};
    bool sees = false;

    template <class Archive>
    void archive(Archive& archive) {
      archive(at, position, sees);
      archive.require(is_finite(at, position));
    }
    [[nodiscard]] std::optional<Pair> what() const {
      return sees ? std::optional(position) : std::nullopt;
    }
  };

  void go_on(Clock& clock) {
    ++clock.number;
    put(clock);
  }
  // At the instant of its number.
  void put(Clock& clock) { clock.next = time_of(clock.number) + clock.shift; }
  [[nodiscard]] double frame_time() const { return expose_.number * *frames_ + expose_.shift; }
  // Whether numbers and queues, just read, are such as a run leaves.
  [[nodiscard]] bool is_sound(double first_exposure) const;
  void go_on_exposing();
  void skip_past();
  void forget_times();

  // What every instant looks at is together.
  bool even_;
  double period_, since_, sensor_delay_, one_instant_;
  Clock expose_, sample_, apply_;
  std::optional<double> frames_;  // the period of a camera's, s
  Queue<Seen> seen_;              // exposed, not yet sampled
  std::optional<Pair> frame_;     // the last one that has come
  Queue<Pair> commands_;          // computed, not yet applied
  bool legs_;                     // whether there are thirds
  Queue<double> thirds_;
  BallSensor sensor_;
  SampleTimes times_;
};

}  // namespace bbsim::model
