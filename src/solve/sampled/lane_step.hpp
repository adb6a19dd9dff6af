// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A piece of the motion of many rigs, with one rig in each SIMD lane.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "model/model.hpp"
#include "model/servo/held_motion.hpp"
#include "solve/sampled/lane_kernel.hpp"
#include "solve/stepper.hpp"

namespace bbsim::solve::sampled {

// A piece of each lane. Valid only until the next pieces.
class LaneStep {
 public:
  // Whether the lane has a piece, and its times, s. to() is at most the end of the run.
  [[nodiscard]] bool has(std::size_t lane) const { return has_[lane]; }
  [[nodiscard]] double from(std::size_t lane) const { return from_[lane]; }
  [[nodiscard]] double to(std::size_t lane) const { return to_[lane]; }

  // Whether a servo may move unseen between two nodes of a piece.
  [[nodiscard]] bool loses_motion() const;
  // Bounds of a column over a lane's piece, if the sizes of motions were evaluated (Piece::bounds).
  [[nodiscard]] std::optional<Bounds> bounds(std::size_t lane, Bounded column, bool closely) const;

  // Evaluates the motion at `count` times (s) within a lane's piece: rows of `row` numbers that
  // begin with the states, packed as in the system.
  void evaluate(std::size_t lane, const double* times, std::size_t count, double* rows,
                std::size_t row) const;
  // The same, but only the ball's states need be right.
  void evaluate_ball(std::size_t lane, const double* times, std::size_t count, double* rows,
                     std::size_t row) const;
  static constexpr std::size_t most_states = model::CoupledLayout<model::most_servos>::states;
  // The rig in a lane, in its present mode.
  [[nodiscard]] const model::Model& model(std::size_t lane) const { return *rigs_[lane].model; }
  // The motions of one servo and of all from the start of the lane's piece.
  [[nodiscard]] model::HeldMotion servo(std::size_t lane, std::size_t axis) const;
  [[nodiscard]] model::HeldMotions servos(std::size_t lane) const;

 private:
  friend class LaneEngine;
  friend class RigLanes;
  friend class SteppedLanes;

  const LanePieces* pieces_ = nullptr;
  const LaneServos* servos_ = nullptr;
  const Kernels* kernels_ = nullptr;
  const LaneKernels* lane_kernels_ = nullptr;
  LaneQuantities quantities_{};
  // The rig of each lane in its present mode, and its states.
  struct Rig {
    const model::Model* model;
    const double* z;
  };
  std::array<Rig, group> rigs_{};
  std::array<bool, group> has_{};
  std::array<double, group> from_{}, to_{};
};

// The piece of a lane as a Stepper, for GuardSearch.
class LaneMotion : public Stepper {
 public:
  LaneMotion(const LaneStep& step, std::size_t lane) : step_(step), lane_(lane) {}

  void evaluate(const double* times, std::size_t count, double* rows) override {
    step_.evaluate(lane_, times, count, rows, step_.model(lane_).size());
  }
  [[nodiscard]] double time() const override { return step_.to(lane_); }
  [[nodiscard]] std::size_t detail() const override { return nodes; }
  // Enough if 8 nodes just resolve the motion.
  [[nodiscard]] std::size_t parts() const override { return 2 * nodes; }
  // GuardSearch only checks that this is not null.
  [[nodiscard]] const model::HeldMotions* servos() const override { return &servos_; }

  // Unused: no driver steps this object.
  void start(double, const double*) override {}
  [[nodiscard]] std::optional<Failure> step(double) override { return step_is_lost; }
  void jump() override {}
  [[nodiscard]] std::vector<double> state() const override { return {}; }
  [[nodiscard]] std::size_t worst_state() const override { return 0; }
  [[nodiscard]] Statistics statistics() const override { return {}; }

 private:
  const LaneStep& step_;
  std::size_t lane_;
  model::HeldMotions servos_{};
};

}  // namespace bbsim::solve::sampled
