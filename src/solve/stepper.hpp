// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The interface of all integrators, one step at a time, and the drivers that run them.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "model/model.hpp"
#include "model/servo/held_motion.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"
#include "solve/piece.hpp"

namespace bbsim::solve {

// States are packed as in the system. With Model::gamma the integral of u = r gamma' follows.
class Stepper {
 public:
  virtual ~Stepper() = default;

  // Restarts from the states z at t (s). Forgets all history, because the model's right-hand side
  // may have changed.
  virtual void start(double t, const double* z) = 0;

  // Makes one step that passes its error test, at most to `limit` (s). The last step before `limit`
  // ends exactly there. Returns a Failure if no step is possible.
  [[nodiscard]] virtual std::optional<Failure> step(double limit) = 0;

  // Evaluates the states at times within the last step, ends included, on the step's polynomial.
  // Writes `count` rows without gaps. Call it before the next step.
  virtual void evaluate(const double* times, std::size_t count, double* rows) = 0;
  // The same, but only the ball's states need be right.
  virtual void evaluate_ball(const double* times, std::size_t count, double* rows) {
    evaluate(times, count, rows);
  }

  // Announces that the input or one of its derivatives jumps at the end of the last step. The
  // step's states are those just before the jump.
  virtual void jump() = 0;

  // The end of the last step, s.
  [[nodiscard]] virtual double time() const = 0;
  // After a failed step(): the states at its start, and the index of the state that failed it.
  [[nodiscard]] virtual std::vector<double> state() const = 0;
  [[nodiscard]] virtual std::size_t worst_state() const = 0;
  [[nodiscard]] virtual Statistics statistics() const = 0;
  // The number of points that resolve a step's polynomial.
  [[nodiscard]] virtual std::size_t detail() const = 0;
  // The number of Chebyshev intervals that resolve a smooth function of states and time over the
  // last step. A step shorter than the tolerance allows needs fewer.
  [[nodiscard]] virtual std::size_t parts() const = 0;

  // The servos' motion since start(), if the stepper moves servos in closed form; otherwise null.
  // If not null, HybridSystem predicts the servos' switches, and no step crosses one.
  [[nodiscard]] virtual const model::HeldMotions* servos() const { return nullptr; }
  // Whether it is certain that no monitor of the scene's events changes sides within the last step,
  // ends included. `occurring` has the present side of each monitor. Call it before the next step.
  [[nodiscard]] virtual bool no_monitor_changes(const std::vector<char>& /*occurring*/) {
    return false;
  }
  // Bounds over the last step, as Piece::bounds().
  [[nodiscard]] virtual std::optional<Bounds> bounds(Bounded /*column*/,
                                                     const model::BallConstants& /*constants*/,
                                                     bool /*closely*/) {
    return {};
  }
};

// Drives a stepper from the model's initial state to the end of the grid and passes the rows to the
// sink. The model must not be hybrid().
[[nodiscard]] Outcome run_through(Stepper& stepper, const model::Model& model,
                                  const OutputGrid& grid, StateSink& sink, const Watch& watch);

using MakeStepper = std::function<std::unique_ptr<Stepper>(const model::Model& model)>;

// Runs a scene that switches, samples or watches for events. Integrates from one switch to the
// next. Calls `make_stepper` once, with the model whose mode the run changes. `tolerances` are
// those of the stepper. The integrator stops at time events. A state event is the root of a guard
// on the step's polynomial, accurate to the rounding of the time.
//
// Rows have Model::row_size() numbers. A row exactly at a switch has the state after it.
class HybridRun {
 public:
  virtual ~HybridRun() = default;

  // Goes on to the end of the run, or to a sample for which an external controller has no answer
  // yet; then it returns nothing. Call it again once there is an answer. The end is
  // Ending::stopped if an event stops the scene. Throws what the sink throws.
  [[nodiscard]] virtual std::optional<Outcome> advance() = 0;
};
// The model, the grid, the sink and the watch must live as long as the run.
[[nodiscard]] std::unique_ptr<HybridRun> begin_hybrid(const model::Model& model,
                                                      const MakeStepper& make_stepper,
                                                      Tolerances tolerances, const OutputGrid& grid,
                                                      StateSink& sink, const Watch& watch);

}  // namespace bbsim::solve
