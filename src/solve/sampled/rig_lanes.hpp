// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Integrates many sampled rigs at once for sweeps, with one rig in each SIMD lane.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <memory>
#include <span>

#include "solve/output_grid.hpp"
#include "solve/sampled/lane_controllers.hpp"
#include "solve/sampled/lane_engine.hpp"

namespace bbsim::solve::sampled {

// Whether RigLanes can integrate the model: it passes fits_lanes(), its law is built in, its axes
// are square and its base is level.
[[nodiscard]] bool fits_sweep_lanes(const model::Model& model);

// Whether two such rigs can share a group: the same kind of law, mechanism and stops. Their periods
// and delays may differ. Their references must be the same, which is not checked.
[[nodiscard]] bool go_together(const model::Model& first, const model::Model& second);

// Receives the motion of the rigs of a group. Data of a lane that is given up later mean nothing.
class LaneSink {
 public:
  virtual ~LaneSink() = default;
  virtual void accept(const LaneStep& step) = 0;
  // Output row `row` of a lane: only x and y of the ball.
  virtual void accept_row(std::size_t lane, std::size_t row, double x, double y) = 0;
  // The same row, complete: Model::row_size() numbers. Only if LaneAsked::rows.
  virtual void accept_whole(std::size_t /*lane*/, std::span<const double> /*row*/) {}
  // The lane's last row, complete: Model::row_size() numbers.
  virtual void accept_end(std::size_t lane, double t, std::span<const double> row) = 0;
};

// What a sink needs besides the ball's position.
struct LaneAsked {
  bool gimbal = false, reference = false;  // the plate's tilt and rate; the tracking error
  bool rows = false;                       // complete rows
};

// Integrates groups of rigs from t = 0 over an output grid (LaneEngine). Laws are computed together
// (LaneControllers).
//
// A rig is given up if an event occurs in it. It must then be run alone. After its first group the
// object allocates little. Use one object per thread.
class RigLanes : private LaneEngine {
 public:
  RigLanes(Tolerances tolerances, const OutputGrid& grid, const LaneAsked& asked);

  // Integrates the first `count` models, 1 <= count <= group. fits_sweep_lanes() and go_together()
  // must hold for them, and they must have the same reference. Returns for each whether it reached
  // the end. Stops early once `stop` is true.
  std::array<bool, group> integrate(const model::Model* const* models, std::size_t count,
                                    LaneSink& sink, const std::atomic<bool>& stop);

 private:
  void begin(std::size_t lane, const model::Model& model, LaneSink& sink);
  void evaluate_quantities();
  void fill_reference();
  void take_reference(std::size_t lane);
  void pass_instants(LaneSink& sink);
  void pass_row(std::size_t lane, LaneSink& sink);
  [[nodiscard]] std::vector<double> whole_row(std::size_t lane, double t) const;

  OutputGrid grid_;
  LaneAsked asked_;
  std::unique_ptr<LaneReference> reference_;  // aligned
  LaneControllers controllers_;
  model::SharedReference shared_reference_;
  std::array<std::size_t, group> next_row_{};
  std::array<bool, group> feeds_servos_back_{};
};

}  // namespace bbsim::solve::sampled
