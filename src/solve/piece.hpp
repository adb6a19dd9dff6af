// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The motion between rows: the smooth pieces of a run.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>

#include "model/ball/dynamics.hpp"

namespace bbsim::solve {

// Columns that an integrator may bound, named like them.
enum class Bounded {
  x,
  y,
  vx,
  vy,
  distance,
  tilt,
  tilt_rate,
  tracking_error,
  motor_torque_phi,
  motor_torque_theta,
  motor_power
};

inline constexpr std::size_t bounded_count = 11;

struct Bounds {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  int trend = 0;  // 1 or -1: the column rises or falls all the way; 0: it may turn
};
using BoundsOfColumns = std::array<Bounds, bounded_count>;

// A step of the integrator, or the part of a step before a switch. Valid only until the run
// continues.
class Piece {
 public:
  Piece(double from, double to, std::size_t parts) : from_(from), to_(to), parts_(parts) {}
  virtual ~Piece() = default;

  [[nodiscard]] double from() const { return from_; }  // s
  // At a switch this is the last instant before it. Values at to() are from before the switch, and
  // values at from() of the next piece from after it.
  [[nodiscard]] double to() const { return to_; }
  // The number of Chebyshev intervals that resolve a smooth function of the rows.
  [[nodiscard]] std::size_t parts() const { return parts_; }
  // Evaluates rows, as a StateSink receives them, at times within the piece, ends included.
  virtual void evaluate(const double* times, std::size_t count, double* rows) const = 0;
  // The same, but only the ball's states need be right.
  virtual void evaluate_ball(const double* times, std::size_t count, double* rows) const {
    evaluate(times, count, rows);
  }
  // Quick bounds of a column over the piece. They may be wider than its true range; `closely`
  // narrows them and takes a little longer. Empty if only rows can show the range.
  [[nodiscard]] virtual std::optional<Bounds> bounds(Bounded /*column*/,
                                                     const model::BallConstants& /*constants*/,
                                                     bool /*closely*/) const {
    return {};
  }

 private:
  double from_, to_;
  std::size_t parts_;
};

// Receives each piece of a run, in order.
class PieceSink {
 public:
  virtual ~PieceSink() = default;
  // Begins a run. Pieces of an earlier attempt, which was given up, no longer count.
  virtual void begin_run() = 0;
  virtual void accept(const Piece& piece) = 0;
  // Whether this sink may miss pieces in which no column leaves its bounds. Narrows the bounds.
  [[nodiscard]] virtual bool may_miss(BoundsOfColumns& /*within*/) const { return false; }
};

}  // namespace bbsim::solve
