// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Many sampled rigs at once, for studies of their gains: another rig in each SIMD lane.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <span>

#include "model/hybrid_system.hpp"
#include "solve/outcome.hpp"
#include "solve/output_grid.hpp"
#include "solve/sampled/instants.hpp"
#include "solve/sampled/lane_controllers.hpp"
#include "solve/sampled/lane_kernel.hpp"
#include "solve/sampled/sampled.hpp"
#include "solve/standstill.hpp"

namespace bbsim::solve::sampled {

// Whether RigLanes carries rigs like this one: knows() does, it is the paper's but for its servos
// and its controller, and the program itself is the controller.
[[nodiscard]] bool carries(const model::Model& model);

// Whether two rigs that it carries can go together: their instants are the same, and so is the kind
// of their law. Their references have to be one too, which it does not look at.
[[nodiscard]] bool go_together(const model::Model& one, const model::Model& other);

// A piece of each lane, to be looked at before the next one.
class LaneStep {
 public:
  // Where the ball is and how the plane stands.
  struct Track {
    double x, y, phi, theta, phi_rate, theta_rate;
  };

  // Whether the lane has a piece, and its times (s). The last one ends with the run, though what
  // is looked at goes on.
  [[nodiscard]] bool has(std::size_t lane) const { return has_[lane]; }
  [[nodiscard]] double from(std::size_t lane) const { return from_[lane]; }
  [[nodiscard]] double to(std::size_t lane) const { return to_[lane]; }
  [[nodiscard]] bool is_whole(std::size_t lane) const { return whole_[lane]; }

  // What a size is at the lane's start and nodes, and what it is there and between.
  [[nodiscard]] Range at_nodes(Size size, std::size_t lane) const {
    const auto i = static_cast<std::size_t>(size);
    return {looks_.least_size[i][lane], looks_.most_size[i][lane]};
  }
  [[nodiscard]] Range bounds(Size size, std::size_t lane) const;

  // At `count` times (s) within a lane's piece.
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

// Is told of rigs that go together. What it is told of a lane that is given up later means nothing.
class LaneSink {
 public:
  virtual ~LaneSink() = default;
  virtual void accept(const LaneStep& step) = 0;
  // Output row `row` of a lane: the ball's x and y alone.
  virtual void accept_row(std::size_t lane, std::size_t row, double x, double y) = 0;
  // The lane's last row, whole (Model::row_size() numbers).
  virtual void accept_end(std::size_t lane, double t, std::span<const double> row) = 0;
};

// What a sink looks at beside the ball's place.
struct LaneAsked {
  bool gimbal = false, reference = false;  // the plane's tilt and rate; the tracking error
};

// Integrates groups of rigs from t = 0 over an output grid. Each has its HybridSystem, and so its
// own sensor, servos and limits; laws are computed together (LaneControllers), and between its
// switches the balls go together, as HeldStepper takes one. What switches in one lane cuts its
// piece alone, and it is behind the others from there on: nobody waits.
//
// A rig in which an event occurs, or may occur as far as the bounds tell, is given up: it is for
// whoever runs one by one. A rig's rows depend, within the tolerance, on its companions, and on
// nothing else. Allocates little once it has run a group; one for each thread.
class RigLanes {
 public:
  RigLanes(Tolerances tolerances, const OutputGrid& grid, const LaneAsked& asked);

  // The first `count` models, 1 <= count <= group, which carries() says yes to and which go
  // together; they have one reference. Whether each was carried to the end; none more once `stop`
  // is true.
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
    double until = 0;              // the end of the present piece
    double step = 0;               // its length, as it was asked for
    double next_step = std::numeric_limits<double>::infinity();
    model::HybridSystem::Fall fall;
    double foreseen = 0;  // until when `fall` tells, s
    std::size_t next_row = 1;
    int rejections = 0;
    Standstill standstill;
    bool alive = false, feeds_servos_back = false;
    bool moved = false, settled = false;      // with the last attempt
    bool restarts = false, switched = false;  // by a command, or by more than that
    bool unforeseen = false;
  };
  // Which table an axis of pieces_ shares, or one of its columns holds.
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
  void foresee(std::size_t lane);
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
  model::HybridSystem::SharedReference shared_reference_;
  std::array<Lane, group> lanes_;
  std::array<std::array<Loaded, group>, 2> loaded_{};
  std::array<Loaded, 2> shared_{};
  std::array<MotionTable, 2> shared_tables_{};
};

}  // namespace bbsim::solve::sampled
