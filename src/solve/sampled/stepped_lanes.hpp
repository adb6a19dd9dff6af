// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Sampled rigs whose commands come from outside, sample by sample, with one rig in each SIMD lane.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "solve/sampled/lane_engine.hpp"

namespace bbsim::solve::sampled {

// A controller's inputs at a sample, in SI units.
struct LaneSample {
  std::optional<Pair> seen;
  std::array<model::Jet<double>, 2> reference{};
  Pair servo{}, servo_rate{};
};

// A group of rigs, each of which begins, waits and ends at its own time. Pieces also end at
// samples, so that a lane can wait there while others move. Events are found in the lanes.
class SteppedLanes : private LaneEngine {
 public:
  // `waits`: at a sample, for its command. `given_up`: the lane cannot go on; run the rig alone,
  // from its start.
  enum class State { empty, waits, done, stopped, given_up };

  explicit SteppedLanes(Tolerances tolerances);

  // Begins a rig in a lane, up to `end` s. It then waits at t = 0. fits_lanes() must hold, and the
  // controller must be external; it is not called.
  void begin(std::size_t lane, const model::Model& model, double end);
  void drop(std::size_t lane);

  [[nodiscard]] State state(std::size_t lane) const { return states_[lane]; }
  // The sample at which the lane waits; if it does not wait, its last one.
  [[nodiscard]] const LaneSample& sample(std::size_t lane) const { return samples_[lane]; }

  // Whether a lane that waits is at its end: its command then only ends it.
  [[nodiscard]] bool is_at_end(std::size_t lane) const;

  // Gives a waiting lane its command, which must be finite. The lane moves at the next advance().
  void answer(std::size_t lane, const Pair& command);
  // Moves the lanes that were answered, each to its next sample or to its end.
  void advance();

 private:
  void ask(std::size_t lane);
  void end(std::size_t lane, State how);
  void evaluate_quantities();
  void search(std::size_t lane);
  void pass_instants();

  std::array<State, group> states_{};
  std::array<LaneSample, group> samples_{};
  std::array<bool, group> asks_{};    // the lane has come to a sample
  std::array<double, group> kept_{};  // the contraction of a lane that waits
  std::vector<double> found_;         // the states at an event
};

}  // namespace bbsim::solve::sampled
