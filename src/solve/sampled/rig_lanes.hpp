// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Integrates many sampled rigs at once for sweeps, with one rig in each SIMD lane.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>

#include "solve/output_grid.hpp"
#include "solve/row_block.hpp"
#include "solve/sampled/lane_controllers.hpp"
#include "solve/sampled/lane_engine.hpp"

namespace bbsim::solve::sampled {

// Whether RigLanes can integrate the model: it passes fits_lanes(), and its law is built in.
[[nodiscard]] bool fits_sweep_lanes(const model::Model& model);

// Whether two such rigs can share a group: the same kind of law, mechanism and stops. Their periods
// and delays may differ. Their references must be the same, which is not checked.
[[nodiscard]] bool go_together(const model::Model& first, const model::Model& second);

// Integrates groups of rigs from t = 0 over an output grid (LaneEngine). Laws are computed together
// (LaneControllers).
//
// A rig is given up if an event occurs in it. It must then be run alone. After its first group the
// object allocates little. Use one object per thread.
class RigLanes : private LaneEngine {
 public:
  RigLanes(Tolerances tolerances, const OutputGrid& grid);

  struct Rig {
    const model::Model* model;
    StateSink* sink;  // what it receives of a rig that is given up later means nothing
  };
  // Integrates rigs, at least one and at most `group`. fits_sweep_lanes() and go_together() must
  // hold for them, and they must have the same reference. Returns for each whether it reached the
  // end. Stops early once `stop` is true.
  std::array<bool, group> integrate(std::span<const Rig> rigs, const std::atomic<bool>& stop);

  // The reference of the present group, for its sinks.
  [[nodiscard]] model::SharedSignals& shared_reference() { return shared_reference_; }

 private:
  class LanePart;

  void begin(std::size_t lane, const Rig& rig);
  void evaluate_quantities();
  void check_events();
  void fill_reference();
  void take_reference(std::size_t lane);
  void publish(std::size_t lane);
  void take_bounds(std::size_t lane);
  [[nodiscard]] std::optional<Bounds> bounds(std::size_t lane, Bounded column, bool closely);
  void pass_instants();
  void pass_row(std::size_t lane);
  void write_extras(std::size_t lane, double t, double* row) const;

  OutputGrid grid_;
  std::array<StateSink*, group> sinks_{};
  std::array<bool, group> misses_{};  // whether the lane's sink may miss pieces
  std::array<std::optional<RowBlock>, group> rows_;
  std::unique_ptr<LaneReference> reference_;  // aligned
  LaneControllers controllers_;
  model::SharedSignals shared_reference_;
  std::array<std::size_t, group> next_row_{};
  std::array<bool, group> feeds_servos_back_{};
};

}  // namespace bbsim::solve::sampled
