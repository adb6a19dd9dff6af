// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solve/sampled/rig_lanes.hpp"

#include <algorithm>
#include <vector>

#include "solve/sampled/column_bounds.hpp"

namespace bbsim::solve::sampled {

bool fits_sweep_lanes(const model::Model& model) {
  return fits_lanes(model) && !model.rig->sampled->external &&
         model.rig->sampled->law.kind != model::LawKind::held;
}

bool go_together(const model::Model& first, const model::Model& second) {
  const model::SampledLoop &a = *first.rig->sampled, &b = *second.rig->sampled;
  return a.law.kind == b.law.kind && first.stops == second.stops &&
         first.system.index() == second.system.index();
}

// A lane's piece, for the sink of its rig.
class RigLanes::LanePart : public solve::Piece {
 public:
  LanePart(RigLanes& of, std::size_t lane)
      : Piece(of.step_.from(lane), of.step_.to(lane), parts), of_(of), lane_(lane) {}

  void evaluate(const double* times, std::size_t count, double* rows) const override {
    const std::size_t row = of_.step_.model(lane_).row_size();
    of_.step_.evaluate(lane_, times, count, rows, row);
    for (std::size_t i = 0; i < count; ++i) of_.write_extras(lane_, times[i], rows + i * row);
  }
  void evaluate_ball(const double* times, std::size_t count, double* rows) const override {
    of_.step_.evaluate_ball(lane_, times, count, rows, of_.step_.model(lane_).row_size());
  }
  [[nodiscard]] std::optional<Bounds> bounds(Bounded column, const model::BallConstants&,
                                             bool closely) const override {
    return of_.bounds(lane_, column, closely);
  }

 private:
  // Enough if 8 nodes just resolve the motion.
  static constexpr std::size_t parts = 2 * nodes;

  RigLanes& of_;
  std::size_t lane_;
};

RigLanes::RigLanes(Tolerances tolerances, const OutputGrid& grid)
    : LaneEngine(tolerances),
      grid_(grid),
      reference_(std::make_unique<LaneReference>()),
      controllers_(kernels_) {
  for (int quantity = 0; quantity < lane_quantity_count; ++quantity) {
    std::fill_n(scene_.known_least[quantity], group, -unlimited);
    std::fill_n(scene_.known_most[quantity], group, unlimited);
  }
}

void RigLanes::begin(std::size_t l, const Rig& rig) {
  const model::Model& model = *rig.model;
  Lane& lane = lanes_[l];
  sinks_[l] = rig.sink;
  if (PieceSink* const pieces = rig.sink->pieces()) pieces->begin_run();
  take_bounds(l);
  constexpr std::size_t rows_together = 32;  // those of all lanes fit into a cache
  rows_[l].emplace(*rig.sink, model.row_size(), rows_together);
  open(l, model, grid_.end(), false);
  lane.run->sampling()->share_reference(shared_reference_);
  feeds_servos_back_[l] = model.rig->sampled->law.feeds_servos_back();
  next_row_[l] = 0;
  lane.run->handle_time_event(0, lane.z.data());
  controllers_.take_over(l, lane.run->sampling()->controller());
  const std::vector<char>& occurring = lane.run->occurring();
  lane.alive = lane.run->check_events(0, lane.z.data()) == model::Effect::none &&
               std::find(occurring.begin(), occurring.end(), 1) == occurring.end();
  pass_row(l);
  start(l);
}

// Evaluates the reference at the start and all nodes but the first, once for lanes with the same
// piece.
void RigLanes::fill_reference() {
  LaneReference& reference = *reference_;
  std::array<std::size_t, group> first{};  // the first lane with the same piece
  int pieces = 0;
  for (std::size_t l = 0; l < group; ++l) {
    if (!step_.has_[l]) continue;
    const auto same = [&](std::size_t k) {
      return step_.has_[k] && step_.from_[k] == step_.from_[l] &&
             pieces_->length[k] == pieces_->length[l];
    };
    while (!same(first[l])) ++first[l];
    if (first[l] == l) ++pieces;
  }
  reference.shared = pieces == 1;
  for (std::size_t l = 0; l < group; ++l) {
    if (!step_.has_[l]) continue;
    if (first[l] == l) take_reference(l);
    for (std::size_t i = 0; i < 2 && !reference.shared; ++i) {
      for (std::size_t n = 0; n < nodes; ++n) {
        auto& at = reference.at[i][n];
        at[l] = first[l] == l ? reference.common[i][n] : at[first[l]];
      }
    }
  }
}

void RigLanes::take_reference(std::size_t l) {
  const model::Model& model = lanes_[l].run->model();
  // Until it jumps, the reference is constant.
  const bool jumps = model.jumps_at(lanes_[l].until);
  const double length = jumps ? step_.to_[l] - step_.from_[l] : pieces_->length[l];
  with_given_plate(model.system, [&](const auto& loop) {
    kernels_.reference(loop.reference().view(), step_.from_[l], length, reference_->common);
  });
}

void RigLanes::evaluate_quantities() {
  if (scene_.sizes) fill_reference();
  kernels_.evaluate_quantities(*pieces_, scene_, *reference_, step_.quantities_);
}

std::optional<Bounds> RigLanes::bounds(std::size_t l, Bounded column, bool closely) {
  if (column >= Bounded::motor_torque_phi) return {};
  if (!scene_.sizes) {  // from the first question on, all pieces have them
    scene_.sizes = true;
    evaluate_quantities();
  }
  return step_.bounds(l, column, closely);
}

// Gives up the rigs in which an event occurs.
void RigLanes::check_events() {
  for (std::size_t l = 0; l < group; ++l) {
    if (!step_.has_[l] || is_quiet(l) || !has_event(l)) continue;
    lanes_[l].alive = lanes_[l].moved = step_.has_[l] = false;
  }
}

void RigLanes::write_extras(std::size_t l, double t, double* row) const {
  const model::HybridSystem& run = *lanes_[l].run;
  run.write_extras(t, row, row + run.model().size());
}

// Passes a lane's piece to its sink. Call it before the mode changes.
void RigLanes::publish(std::size_t l) {
  PieceSink* const pieces = sinks_[l]->pieces();
  if (pieces == nullptr || !step_.has(l)) return;
  if (misses_[l] && step_.quantities_.known[l] != 0 && !step_.loses_motion()) return;
  const LanePart part(*this, l);
  if (!(part.to() > part.from())) return;
  pieces->accept(part);
  if (misses_[l]) take_bounds(l);
}

// Takes the bounds within which the lane's sink may miss pieces.
void RigLanes::take_bounds(std::size_t l) {
  PieceSink* const pieces = sinks_[l]->pieces();
  BoundsOfColumns within;
  misses_[l] = pieces != nullptr && pieces->may_miss(within) && !bounds_loads(within);
  if (!misses_[l]) return;
  scene_.sizes = true;
  for_each_bound(within, [&](Quantity quantity, double least, double most) {
    scene_.known_least[quantity][l] = least;
    scene_.known_most[quantity][l] = most;
  });
}

// Passes on the next row of a lane, which has its state.
void RigLanes::pass_row(std::size_t l) {
  const std::size_t row = next_row_[l]++;
  const bool is_end = row == 0 || next_row_[l] == grid_.size();
  if (!is_end && !sinks_[l]->wants_rows()) return rows_[l]->skip(1);
  double* const values = rows_[l]->next();
  std::copy_n(lanes_[l].z.begin(), lanes_[l].run->model().size(), values);
  if (is_end || !sinks_[l]->wants_ball_only()) write_extras(l, grid_[row], values);
}

// Takes samples, applies commands and passes rows on, each at its time, up to the ends of the
// pieces.
void RigLanes::pass_instants() {
  const auto row_time = [this](std::size_t l) { return grid_[next_row_[l]]; };
  NextInstants next;
  while (find_instants(row_time, next)) {
    for (std::size_t l = 0; l < group; ++l) {
      Lane& lane = lanes_[l];
      if (!lane.moved || lane.settled) continue;
      const double t = next.when[l];
      const bool last = grid_.end() - t <= lane.run->rounding(t);
      const bool is_row = sinks_[l]->wants_rows() && !sinks_[l]->wants_ball_only() &&
                          grid_[next_row_[l]] - t <= lane.run->rounding(t);
      state_at(l, t, next.ball, (next.is_event[l] && feeds_servos_back_[l]) || is_row || last);
      if (!next.is_event[l]) continue;
      lane.run->observe(t, lane.z.data());
      if (lane.run->samples_at(t)) controllers_.sample(l, *lane.run, t, lane.z.data());
    }
    controllers_.finish();
    for (std::size_t l = 0; l < group; ++l) {
      Lane& lane = lanes_[l];
      if (!lane.moved || lane.settled) continue;
      const double t = next.when[l];
      if (next.is_event[l]) {
        lane.run->act(t, lane.z.data());
        lane.restarts = lane.settled = lane.run->touched();
        lane.switched = lane.switched || !lane.run->only_commanded();
      }
      while (next_row_[l] < grid_.size() &&
             grid_[next_row_[l]] - t <= (next.is_event[l] ? lane.run->rounding(t) : 0)) {
        pass_row(l);
      }
      if (next_row_[l] == grid_.size()) {
        rows_[l]->flush();
        lane.alive = lane.moved = false;
      } else if (lane.restarts) {
        lane.until = t;
      }
    }
  }
}

std::array<bool, group> RigLanes::integrate(std::span<const Rig> rigs,
                                            const std::atomic<bool>& stop) {
  scene_.force = false;
  controllers_.begin();
  shared_reference_ = {};
  make_room(*rigs.front().model);
  for (std::size_t l = 0; l < group; ++l) {
    if (l < rigs.size()) {
      begin(l, rigs[l]);
    } else {
      lanes_[l].alive = lanes_[l].moved = false;
    }
  }
  const auto limit_of = [](const Lane& lane) { return lane.run->next_change(); };
  while (!stop.load(std::memory_order_relaxed) && plan(limit_of)) {
    kernels_.attempt(*pieces_, scene_);
    judge();
    evaluate_quantities();
    check_events();
    for (std::size_t l = 0; l < rigs.size(); ++l) publish(l);
    pass_instants();
    for (std::size_t l = 0; l < group; ++l) {
      if (lanes_[l].moved) go_on(l);
    }
  }
  std::array<bool, group> done{};
  for (std::size_t l = 0; l < rigs.size(); ++l) done[l] = next_row_[l] == grid_.size();
  return done;
}

}  // namespace bbsim::solve::sampled
