// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The microcontroller of a rig: it measures the ball and computes a command once a sample.
#pragma once

#include <array>
#include <cmath>
#include <optional>

#include "base/noise.hpp"
#include "model/control/sampled_law.hpp"
#include "model/systems/rig.hpp"

namespace bbsim::model {

// A position after the sensor's rotation and scale, without its offset; m.
template <class Real>
[[nodiscard]] std::array<Real, 2> turned(const Sensor& sensor, const Real& x, const Real& y) {
  const double c = std::cos(sensor.rotation), s = std::sin(sensor.rotation);
  return {sensor.scale[0] * (c * x - s * y), sensor.scale[1] * (s * x + c * y)};
}

// A touch screen or a camera, read once a sample.
class BallSensor {
 public:
  explicit BallSensor(const Sensor& sensor);

  // Reads a ball at (x, y), m, and returns whether the sensor gives a position. (Two numbers,
  // because reading a pair right after its halves were written is slow.) `firm`: the contact force
  // is enough for a touch screen.
  [[nodiscard]] bool read(double x, double y, Pair& seen, bool firm = true);

 private:
  [[nodiscard]] Pair aligned(double x, double y) const;
  [[nodiscard]] Pair rounded(const Pair& says) const;
  [[nodiscard]] bool miss(Pair& seen) const;

  Sensor sensor_;
  Noise noise_;
  std::optional<Pair> last_;       // reading of the ball, for OnMiss::last
  std::optional<Noise> dropouts_;  // a separate sequence, so that the noise does not change
};

// The law of a sampled loop (sampled_law.hpp). It has no velocity sensor: velocities are
// differences of measured positions, with a first-order filter.
class SampledController {
 public:
  explicit SampledController(const SampledLoop& loop);

  // The command after a sample: rad, or rad/s^2 if accelerations are driven. `servo` holds the
  // servos' angles (rad) and rates (rad/s), for laws that feed them back. A sample that missed the
  // ball keeps the last command.
  [[nodiscard]] Pair command(const std::optional<Pair>& seen, const double (&servo)[4],
                             const std::array<Jet<double>, 2>& reference);

  // Rounds a command of phi and theta, or of servos, to the nearest multiple of its resolution
  // within its limit.
  [[nodiscard]] Pair within_limits(Pair command) const;

  // What the servos receive for such a command: itself, or the linkage's servo angles in steps of
  // the resolution. Two stay within the limit; rounding of three may move the plane slightly beyond
  // it.
  [[nodiscard]] std::array<double, 3> servo_commands(Pair command) const;

  // Last measured position; (0, 0) before the first sample.
  [[nodiscard]] Pair last_seen() const { return {memory_.position[0], memory_.position[1]}; }

  // Everything that command() reads and writes, for callers that compute several at once.
  [[nodiscard]] const SampledLaw<double>& law() const { return law_; }
  [[nodiscard]] const SampledMemory<double>& memory() const { return memory_; }
  [[nodiscard]] Pair last_command() const { return command_; }
  [[nodiscard]] const SinceSeen& since_seen() const { return since_; }

 private:
  double period_, resolution_;  // of samples, s, and of servo commands
  Mechanism mechanism_;
  CommandRange servo_[2];  // with a linkage: multiples of the resolution within the limit, rad
  SampledLaw<double> law_;
  SampledMemory<double> memory_{};
  SinceSeen since_;
  Pair command_{0, 0};
};

}  // namespace bbsim::model
