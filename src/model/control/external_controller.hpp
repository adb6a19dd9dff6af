// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A controller that is not built in: the model knows when it is asked and what for, and nothing of
// who answers (src/controller).
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

// The commands for phi and theta; or those of three servos, where the controller drives legs.
using Commands = std::array<double, 3>;

// What it is told at a sample, SI.
struct ControllerSample {
  std::size_t number;               // from 0
  double t;                         // s
  const std::optional<Pair>& seen;  // of the ball, m; nothing if the sensor missed it
  // Of what it commands, phi and theta or three servos: angles (rad) and rates (rad/s).
  std::span<const double> servo, servo_rate;
  const std::array<Jet<double>, 2>& reference;  // m, m/s, m/s^2
};

// It did not do its part, and the run ends. what() says what was asked and what came instead.
class ControllerFault : public std::runtime_error {
 public:
  // `interrupted`: it was asked to end, and is not at fault.
  explicit ControllerFault(const std::string& message, bool interrupted = false)
      : std::runtime_error(message), interrupted_(interrupted) {}
  [[nodiscard]] bool interrupted() const { return interrupted_; }

 private:
  bool interrupted_;
};

class ExternalController {
 public:
  virtual ~ExternalController() = default;

  // A run begins: what it remembers of another is to be forgotten. Throws ControllerFault.
  virtual void begin() = 0;

  // As many commands as there are servos in the sample, all finite; and into `own` the numbers
  // that SampledLoop::own_columns names. Throws ControllerFault.
  virtual Commands command(const ControllerSample& sample, double* own) = 0;

  // Whether it can tell what it remembers, and go on from there.
  [[nodiscard]] virtual bool can_save() const = 0;
  // What it remembers, for another one's restore(). Throws ControllerFault.
  [[nodiscard]] virtual std::string save() = 0;
  // In place of begin(), in a run that goes on. Throws ControllerFault.
  virtual void restore(const std::string& memory) = 0;
};

}  // namespace bbsim::model
