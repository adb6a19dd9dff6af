// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// One integrator, a step at a time: what all of them do for whoever drives them.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "base/archive.hpp"
#include "model/model.hpp"
#include "model/servo/held_motion.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"
#include "solve/part.hpp"
#include "solve/piece.hpp"

namespace bbsim::solve {

// States are packed as the system does it; with Model::gamma the integral of u = r gamma' follows.
class Stepper {
 public:
  virtual ~Stepper() = default;

  // Begins anew from states at t, without memory: the model's right-hand side may have changed.
  virtual void start(double t, const double* z) = 0;

  // One step that passes its error test, not beyond `limit`; the last one before it reaches it
  // exactly. Returns why there is none, if so.
  [[nodiscard]] virtual std::optional<Failure> step(double limit) = 0;

  // Gives the states at times within the last step, ends included, by its own polynomial; `count`
  // rows without gaps. To be called before the next step.
  virtual void evaluate(const double* times, std::size_t count, double* rows) = 0;

  // A derivative of the input jumps here, at the end of the last step.
  virtual void jump() = 0;

  // The end of the last step, s.
  [[nodiscard]] virtual double time() const = 0;
  // After a step() that failed: the states that it started from, and which one failed it.
  [[nodiscard]] virtual std::vector<double> state() const = 0;
  [[nodiscard]] virtual std::size_t worst_state() const = 0;
  [[nodiscard]] virtual Statistics statistics() const = 0;
  // How many points of a step show all that its polynomial can do.
  [[nodiscard]] virtual std::size_t detail() const = 0;
  // Chebyshev points of so many intervals show what a smooth function of the states, and of the
  // time, does over the last step. A step shorter than the tolerance allows needs fewer.
  [[nodiscard]] virtual std::size_t parts() const = 0;

  // How servos move from start() on, of a stepper that moves them in closed form; else null. Then
  // HybridSystem tells when one switches, and no step goes beyond.
  [[nodiscard]] virtual const std::array<model::HeldMotion, 2>* servos() const { return nullptr; }
  // Whether, for sure, no monitor of the scene's events changes its side within the last step,
  // start and end included: `happening` says of each which one it is on. To be called before the
  // next step.
  [[nodiscard]] virtual bool nothing_happens(const std::vector<char>& /*happening*/) {
    return false;
  }
  // Of the last step, as Piece::bounds().
  [[nodiscard]] virtual std::optional<Bounds> bounds(Load /*load*/,
                                                     const model::BallConstants& /*constants*/,
                                                     bool /*closely*/) {
    return {};
  }

  // All that it remembers, for another stepper of this model, method and tolerances: its steps are
  // then those that this one would have made, to the bit. False if the integrator does not give it
  // away.
  [[nodiscard]] virtual bool save(StateWriter& /*into*/) { return false; }
  // Takes the place of start(). Throws InputError where the bytes are not such a stepper's.
  virtual void restore(StateReader& /*from*/) {}
  // The earliest end of a run whose steps would have been those that were made with an infinite
  // limit, s.
  [[nodiscard]] virtual double least_end() const { return 0; }
};

// Drives a stepper from the model's initial state to the end of the grid, and hands on the rows.
// The model is not hybrid().
[[nodiscard]] Outcome run_through(Stepper& stepper, const model::Model& model,
                                  const OutputGrid& grid, StateSink& sink, const Watch& watch,
                                  Part* part = nullptr);

}  // namespace bbsim::solve
