// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Moves many sampled rigs from instant to instant, with one rig in each SIMD lane: the base of
// RigLanes and SteppedLanes.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>

#include "model/hybrid/hybrid_system.hpp"
#include "solve/hybrid/guard_search.hpp"
#include "solve/outcome.hpp"
#include "solve/pace.hpp"
#include "solve/sampled/held_plate.hpp"
#include "solve/sampled/instants.hpp"
#include "solve/sampled/lane_kernel.hpp"
#include "solve/sampled/lane_step.hpp"
#include "solve/sampled/sampled.hpp"

namespace bbsim::solve::sampled {

// Whether lanes can move the model: it passes can_step(), has no gamma, does not count the servos'
// work, no stepper rings, and its commands are not angles of three servos.
[[nodiscard]] bool fits_lanes(const model::Model& model);

// Each rig keeps its HybridSystem with its own sensor, servos and limits. The balls are computed
// together between switches, each as in HeldStepper. A switch in one lane cuts only that lane's
// piece. The lane is then behind the others, and lanes do not wait for each other.
//
// Within the tolerance, a rig's motion varies with its companions. It depends on nothing else.
class LaneEngine {
 protected:
  explicit LaneEngine(Tolerances tolerances);
  ~LaneEngine() = default;

  struct Lane {
    std::optional<model::HybridSystem> run;
    std::optional<Instants> instants;
    std::optional<HeldPlate> plate;
    MotionTables tables{choose_kernels()};
    std::array<double, LaneStep::most_states> z{};  // at `time`
    double time = 0;                                // s
    double end = 0;                                 // of the run, s
    double limit = 0;                               // that the present piece reaches at most, s
    double until = 0;                               // end of the present piece, s
    double step = 0;  // its length before rounding to the nominal one, s
    StepControl steps;
    model::Crossing crossing;
    double predicted_to = 0;  // crossings are predicted up to here, s
    Standstill standstill;
    bool alive = false;
    bool waits = false;                   // does not move for now
    bool moved = false, settled = false;  // by the last attempt
    // A command restarts the servos, or something else switched.
    bool restarts = false, switched = false;
    bool unpredicted = false;
  };

  // Opens a run up to `end` s in a lane. The caller then handles what is due at t = 0 and calls
  // start(). `cut`: pieces end at samples, too.
  void open(std::size_t lane, const model::Model& model, double end, bool cut);
  void start(std::size_t lane);
  void clear(std::size_t lane);

  // A round: plan(), the kernels' attempt, judge(), the caller's work on the pieces, and go_on()
  // for each lane that moved. plan() calls limit_of(lane) for the limit of each piece, and returns
  // false if no lane moves.
  template <class Limit>
  bool plan(const Limit& limit_of);
  void judge();
  void go_on(std::size_t lane);

  // The next instant of each lane within its piece, and the ball there: x, y, x', y', u.
  struct alignas(64) NextInstants {
    double after[group], ball[5][group];  // s after the start of the piece
    double when[group];                   // s
    bool is_event[group];                 // an event of the run; otherwise the caller's
  };
  // Finds each lane's next instant: an event, or the caller's time_of(lane), such as a row. A lane
  // without one up to the end of its piece is settled. Returns false if all are.
  template <class TimeOf>
  bool find_instants(const TimeOf& time_of, NextInstants& next);

  void take_commands(std::size_t lane);
  void take_mode(std::size_t lane);
  void put_start(std::size_t lane);
  // Sets the state at t within a lane's piece, or at its end. `ball` must hold the balls at t. Sets
  // the servos' states if `servos`, and always at the end.
  void state_at(std::size_t lane, double t, const double (*ball)[group], bool servos);
  // Discards the servo motions that were computed for other rigs.
  void forget_tables();
  // Makes room for rigs like the model: all that move at once have, or do not have, a mechanism.
  void make_room(const model::Model& model);
  // Whether the model's servos are those that the lanes have room for.
  [[nodiscard]] bool has_room(const model::Model& model) const;
  // Whether bounds exclude every event over a lane's piece; and if not, whether one occurs.
  [[nodiscard]] bool is_quiet(std::size_t lane) const;
  [[nodiscard]] bool has_event(std::size_t lane);
  // The search for events in a lane. A new one has checked no monitor since the last switch.
  GuardSearch& search_in(std::size_t lane);

  Tolerances tolerances_;
  const LaneKernels& kernels_;
  std::unique_ptr<LanePieces> pieces_;  // aligned
  std::unique_ptr<LaneServos> servos_;
  LaneScene scene_{};
  LaneStep step_;
  std::array<Lane, group> lanes_;
  std::array<std::optional<GuardSearch>, group> searches_;

 private:
  // The law and length of the table that pieces_ has for an axis, in a lane or in all.
  struct Loaded {
    model::HeldLaw law{};
    double length = -1;

    bool operator==(const Loaded&) const = default;
  };

  void take_monitors(std::size_t lane, const model::Model& model);
  void predict_crossing(std::size_t lane);
  void plan_lane(std::size_t lane, double limit);
  void load_tables(std::size_t axis);

  void load_plates();

  std::array<std::optional<LaneMotion>, group> motions_;
  using Plates = std::array<PlateMotion, group>;
  std::unique_ptr<Plates> plates_ = std::make_unique<Plates>();  // aligned
  std::array<std::array<Loaded, group>, 2> loaded_{};
  std::array<Loaded, 2> shared_{};
  std::array<MotionTable, 2> shared_tables_{};
};

template <class Limit>
bool LaneEngine::plan(const Limit& limit_of) {
  bool any = false;
  kernels_.start(*pieces_, *servos_);
  for (std::size_t l = 0; l < group; ++l) {
    Lane& lane = lanes_[l];
    lane.moved = lane.alive && !lane.waits;
    any = any || lane.moved;
    lane.restarts = lane.switched = lane.settled = false;
    pieces_->length[l] = 0;
    if (!lane.alive) clear(l);
    if (!lane.moved) continue;
    if (lane.unpredicted) predict_crossing(l);
    plan_lane(l, std::min(limit_of(lane), lane.crossing.time));
  }
  if (pieces_->plates != nullptr) {
    load_plates();
  } else {
    for (std::size_t i = 0; i < 2; ++i) load_tables(i);
  }
  return any;
}

template <class TimeOf>
bool LaneEngine::find_instants(const TimeOf& time_of, NextInstants& next) {
  bool any = false, within = false;
  for (std::size_t l = 0; l < group; ++l) {
    Lane& lane = lanes_[l];
    next.after[l] = 0;
    if (!lane.moved || lane.settled) continue;
    const double due = lane.run->next_time_event(), asked = time_of(l);
    const bool is_event = !(asked < due - lane.run->rounding(due));
    double when = is_event ? due : asked;
    // A sample and a command at one instant may differ by rounding. The command's time counts.
    if (is_event && lane.run->changes_at(due)) when = lane.run->next_change();
    next.when[l] = when;
    next.is_event[l] = is_event;
    if (when > lane.until + (is_event ? 0 : lane.run->rounding(lane.until))) {
      lane.settled = true;
      continue;
    }
    any = true;
    if (when >= lane.until) continue;
    next.after[l] = when - lane.time;
    within = true;
  }
  if (within) kernels_.evaluate(*pieces_, next.after, next.ball);
  return any;
}

}  // namespace bbsim::solve::sampled
