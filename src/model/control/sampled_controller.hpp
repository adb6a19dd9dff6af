// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The microcontroller of a rig: what it sees of the ball and what it makes of it, once a sample.
#pragma once

#include <array>
#include <cmath>
#include <optional>

#include "base/noise.hpp"
#include "model/control/sampled_law.hpp"
#include "model/systems/rig.hpp"

namespace bbsim::model {

// What a sensor makes of a position by its rotation and scale, without its offset; m.
template <class Real>
[[nodiscard]] std::array<Real, 2> turned(const Sensor& sensor, const Real& x, const Real& y) {
  const double c = std::cos(sensor.rotation), s = std::sin(sensor.rotation);
  return {sensor.scale[0] * (c * x - s * y), sensor.scale[1] * (s * x + c * y)};
}

// A touch screen or a camera, read once a sample.
class BallSensor {
 public:
  explicit BallSensor(const Sensor& sensor);

  // Whether it sees a ball at (x, y), m, from where it stands, and what it says of it. (Numbers one
  // by one: a pair that was just written by halves is slow to be read as a whole.)
  [[nodiscard]] bool read(double x, double y, Pair& seen);

  // What of it changes over a run (base/archive.hpp): how far noise and dropouts are drawn.
  template <class Archive>
  void archive(Archive& archive) {
    archive(noise_);
    if (dropouts_) archive(*dropouts_);
  }

 private:
  Sensor sensor_;
  Noise noise_;
  std::optional<Noise> dropouts_;  // a sequence apart, which leaves the noise as it is without
};

// The law of a sampled loop (sampled_law.hpp). It has no velocity sensor: velocities are
// differences of what it saw, behind a filter of first order.
class SampledController {
 public:
  explicit SampledController(const SampledLoop& loop);

  // The command after a sample: rad, or rad/s^2 where accelerations are driven. `servo` is the
  // servos' angles (rad) and rates (rad/s), for laws that feed them back. A sample that saw
  // nothing changes nothing.
  [[nodiscard]] Pair command(const std::optional<Pair>& seen, const double (&servo)[4],
                             const std::array<Jet<double>, 2>& reference);

  // What is left of a command of phi and theta, or of servos: the nearest multiple of its
  // resolution, within its limit.
  [[nodiscard]] Pair within_limits(Pair command) const;

  // What the servos are told for such a command: itself, or what the linkage makes of it, in steps
  // of the resolution. Two, within the limit; or three, whose rounding may move the plane a little
  // beyond it.
  [[nodiscard]] std::array<double, 3> told(Pair command) const;

  // What it saw last; before the first sample, (0, 0).
  [[nodiscard]] Pair last_seen() const { return {memory_.position[0], memory_.position[1]}; }

  // For who computes for several at once: all that command() takes and leaves.
  [[nodiscard]] const SampledLaw<double>& law() const { return law_; }
  [[nodiscard]] const SampledMemory<double>& memory() const { return memory_; }
  [[nodiscard]] Pair last_command() const { return command_; }
  [[nodiscard]] const SinceSeen& since_seen() const { return since_; }

  // What it remembers (base/archive.hpp).
  template <class Archive>
  void archive(Archive& archive) {
    archive(since_.any, since_.unseen, memory_, command_);
    archive.require(since_.unseen >= 0 && is_finite(memory_, command_));
  }

 private:
  double period_, resolution_;  // of samples, s, and of what the servos are told
  Between between_;
  CommandRange servo_[2];  // behind a linkage: multiples of the resolution within the limit, rad
  SampledLaw<double> law_;
  SampledMemory<double> memory_{};
  SinceSeen since_;
  Pair command_{0, 0};
};

}  // namespace bbsim::model
