// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The motion between rows: the smooth pieces that a run consists of.
#pragma once

#include <cstddef>
#include <optional>

#include "model/ball/dynamics.hpp"

namespace bbsim::solve {

// What the motors give, in the columns of those names.
enum class Load { motor_torque_phi, motor_torque_theta, motor_power };

struct Bounds {
  double least, most;
};

// A step of the integrator, or the part of one before something switched. To be looked at before
// the run goes on.
class Piece {
 public:
  Piece(double from, double to, std::size_t parts) : from_(from), to_(to), parts_(parts) {}
  virtual ~Piece() = default;

  [[nodiscard]] double from() const { return from_; }  // s
  // Where the piece ends at a switch, the last instant before it: what is evaluated there is of
  // this side of the switch, and at from() of the next piece of the other one.
  [[nodiscard]] double to() const { return to_; }
  // Chebyshev points of so many intervals show what a smooth function of the rows does.
  [[nodiscard]] std::size_t parts() const { return parts_; }
  // Rows as a StateSink gets them, at times within the piece, ends included.
  virtual void evaluate(const double* times, std::size_t count, double* rows) const = 0;
  // Between which numbers a load stays over the piece, at the least: wider than it does, but told
  // at once; `closely` takes a little longer. Nothing where that is not known without evaluating
  // rows.
  [[nodiscard]] virtual std::optional<Bounds> bounds(Load /*load*/,
                                                     const model::BallConstants& /*constants*/,
                                                     bool /*closely*/) const {
    return {};
  }

 private:
  double from_, to_;
  std::size_t parts_;
};

// Is told of each piece of a run, in order.
class PieceSink {
 public:
  virtual ~PieceSink() = default;
  // A run begins. What came of another one, which was given up, does not count.
  virtual void begin_run() = 0;
  virtual void accept(const Piece& piece) = 0;
};

}  // namespace bbsim::solve
