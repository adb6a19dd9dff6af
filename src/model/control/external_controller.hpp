// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A controller that is not built in. The model knows when to ask it and for what; src/controller
// knows who answers.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>

#include "base/pair.hpp"
#include "model/signals/spline.hpp"

namespace bbsim::model {

// The commands for phi and theta, or for three servos if the controller drives legs.
using Commands = std::array<double, 3>;

// What the controller receives at a sample, SI.
struct ControllerSample {
  std::size_t number;               // from 0
  double t;                         // s
  const std::optional<Pair>& seen;  // position of the ball, m; empty if the sensor missed it
  // Angles (rad) and rates (rad/s) of what it commands: phi and theta, or three servos.
  std::span<const double> servo, servo_rate;
  const std::array<Jet<double>, 2>& reference;  // m, m/s, m/s^2
};

// A failure of the controller, which ends the run. what() names the request and the reply.
class ControllerFault : public std::runtime_error {
 public:
  // `interrupted`: the controller was asked to end, and is not at fault.
  explicit ControllerFault(const std::string& message, bool interrupted = false)
      : std::runtime_error(message), interrupted_(interrupted) {}
  [[nodiscard]] bool interrupted() const { return interrupted_; }

 private:
  bool interrupted_;
};

class ExternalController {
 public:
  virtual ~ExternalController() = default;

  // Begins a run; the controller forgets any earlier one. Throws ControllerFault.
  virtual void begin() = 0;

  // Whether it can answer a sample now. If not, the run pauses before the sample, and asks again
  // when it continues.
  virtual bool has_answer(const ControllerSample& /*sample*/) { return true; }

  // Returns as many commands as the sample has servos, all finite. Writes the numbers that
  // SampledLoop::own_columns names to `own`. Throws ControllerFault.
  virtual Commands command(const ControllerSample& sample, double* own) = 0;
};

}  // namespace bbsim::model
