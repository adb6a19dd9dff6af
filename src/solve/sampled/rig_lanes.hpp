// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Integrates many sampled rigs at once for sweeps, with one rig in each SIMD lane.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <span>

#include "model/hybrid/hybrid_system.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"
#include "solve/sampled/instants.hpp"
#include "solve/sampled/lane_controllers.hpp"
#include "solve/sampled/lane_kernel.hpp"
#include "solve/sampled/sampled.hpp"
#include "solve/standstill.hpp"

namespace bbsim::solve::sampled {

// Whether RigLanes can integrate the model: it passes knows(), it is the paper's rig but for its
// servos and controller, and its law is built in.
[[nodiscard]] bool carries(const model::Model& model);

// Whether two such rigs can share a group: the same kind of law and the same stops. Their periods
// and delays may differ. Their references must be the same, which is not checked.
[[nodiscard]] bool go_together(const model::Model& one, const model::Model& other);

// A piece of each lane. Valid only until the next pieces.
class LaneStep {
 public:
  // The position of the ball and the angles and rates of the plate.
  struct Track {
    double x, y, phi, theta, phi_rate, theta_rate;
  };

  // Whether the lane has a piece, and its times, s. to() is at most the end of the run; if the
  // piece goes on beyond, is_whole() is false and at_nodes() includes that part.
  [[nodiscard]] bool has(std::size_t lane) const { return has_[lane]; }
  [[nodiscard]] double from(std::size_t lane) const { return from_[lane]; }
  [[nodiscard]] double to(std::size_t lane) const { return to_[lane]; }
  [[nodiscard]] bool is_whole(std::size_t lane) const { return whole_[lane]; }

  // The range of a size at the lane's start and nodes, and bounds over the whole piece.
  [[nodiscard]] Range at_nodes(Size size, std::size_t lane) const {
    const auto i = static_cast<std::size_t>(size);
    return {looks_.least_size[i][lane], looks_.most_size[i][lane]};
  }
  [[nodiscard]] Range bounds(Size size, std::size_t lane) const;

  // Evaluates `count` times (s) within a lane's piece.
  void evaluate(std::size_t lane, const double* times, std::size_t count, Track* track) const;

 private:
  friend class RigLanes;

  [[nodiscard]] model::HeldMotion servo(std::size_t lane, std::size_t axis) const;

  const LanePieces* pieces_ = nullptr;
  const LaneServos* servos_ = nullptr;
  const Kernels* kernels_ = nullptr;
  const LaneKernels* lane_kernels_ = nullptr;
  LaneLooks looks_{};
  std::array<bool, group> has_{}, whole_{};
  std::array<double, group> from_{}, to_{};
};

// Receives the motion of the rigs of a group. Data of a lane that is given up later mean nothing.
class LaneSink {
 public:
  virtual ~LaneSink() = default;
  virtual void accept(const LaneStep& step) = 0;
  // Output row `row` of a lane: only x and y of the ball.
  virtual void accept_row(std::size_t lane, std::size_t row, double x, double y) = 0;
  // The lane's last row, complete: Model::row_size() numbers.
  virtual void accept_end(std::size_t lane, double t, std::span<const double> row) = 0;
};

// What a sink needs beside the ball's position.
struct LaneAsked {
  bool gimbal = false, reference = false;  // the plate's tilt and rate; the tracking error
};

// Integrates groups of rigs from t = 0 over an output grid. Each rig keeps its HybridSystem with
// its own sensor, servos and limits. Laws are computed together (LaneControllers), and so are the
// balls between switches, each as in HeldStepper. A switch in one lane cuts only that lane's piece.
// The lane is then behind the others, and lanes do not wait for each other.
//
// A rig is given up if an event occurs in it, or if bounds cannot exclude one. It must then be run
// alone. Within the tolerance, a rig's rows depend on its companions, and on nothing else. After
// its first group the object allocates little. Use one object per thread.
class RigLanes {
 public:
  RigLanes(Tolerances tolerances, const OutputGrid& grid, const LaneAsked& asked);

  // Integrates the first `count` models, 1 <= count <= group. carries() and go_together() must hold
  // for them, and they must have the same reference. Returns for each whether it reached the end.
  // Stops early once `stop` is true.
  std::array<bool, group> integrate(const model::Model* const* models, std::size_t count,
                                    LaneSink& sink, const std::atomic<bool>& stop);

 private:
  using Loop = model::RigLoop<false>;
  static constexpr std::size_t size = Loop::size;

  struct Lane {
    std::optional<model::HybridSystem> run;
    std::optional<Instants> instants;
    MotionTables tables{choose_kernels()};
    std::array<double, size> z{};  // at `time`
    double time = 0;               // s
    double until = 0;              // end of the present piece, s
    double step = 0;               // its length before rounding to the nominal one, s
    double next_step = std::numeric_limits<double>::infinity();
    model::Crossing crossing;
    double predicted_to = 0;  // crossings are predicted up to here, s
    std::size_t next_row = 1;
    int rejections = 0;
    Standstill standstill;
    bool alive = false, feeds_servos_back = false;
    bool moved = false, settled = false;  // by the last attempt
    // A command restarts the servos, or something else switched.
    bool restarts = false, switched = false;
    bool unpredicted = false;
  };
  // The law and length of the table that an axis of pieces_ has in a lane, or in all.
  struct Loaded {
    model::HeldLaw law{};
    double length = -1;

    bool operator==(const Loaded&) const = default;
  };

  void begin(std::size_t lane, const model::Model& model, LaneSink& sink);
  void clear(std::size_t lane);
  void take_commands(std::size_t lane);
  void take_mode(std::size_t lane);
  void put_start(std::size_t lane);
  void predict_crossing(std::size_t lane);
  bool plan();
  void load_tables(std::size_t axis);
  void judge();
  void look();
  void fill_reference();
  void take_reference(std::size_t lane);
  void take_monitors(std::size_t lane, const model::Model& model);
  void pass_instants(LaneSink& sink);
  void state_at(std::size_t lane, double t, const double (*ball)[group], bool servos);
  void go_on(std::size_t lane);
  void end_lane(std::size_t lane, double t, LaneSink& sink);

  Tolerances tolerances_;
  OutputGrid grid_;
  LaneAsked asked_;
  const LaneKernels& kernels_;
  std::unique_ptr<LanePieces> pieces_;  // aligned
  std::unique_ptr<LaneServos> servos_;
  std::unique_ptr<LaneReference> reference_;
  LaneControllers controllers_;
  LaneScene scene_{};
  LaneStep step_;
  model::SharedReference shared_reference_;
  std::array<Lane, group> lanes_;
  std::array<std::array<Loaded, group>, 2> loaded_{};
  std::array<Loaded, 2> shared_{};
  std::array<MotionTable, 2> shared_tables_{};
};

}  // namespace bbsim::solve::sampled
