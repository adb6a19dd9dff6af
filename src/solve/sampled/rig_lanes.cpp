// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solve/sampled/rig_lanes.hpp"

#include <algorithm>
#include <vector>

namespace bbsim::solve::sampled {

bool fits_sweep_lanes(const model::Model& model) {
  if (!fits_lanes(model) || model.rig->sampled->external ||
      model.rig->sampled->law.kind == model::LawKind::held) {
    return false;
  }
  // The sizes of the plate's motion suppose axes that are square and a level base.
  bool square = false;
  with_given_plate(model.system, [&](const auto& loop) {
    square = loop.rolling().sin_skew == 0 && loop.rolling().sin_base == 0;
  });
  return square;
}

bool go_together(const model::Model& first, const model::Model& second) {
  const model::SampledLoop &a = *first.rig->sampled, &b = *second.rig->sampled;
  return a.law.kind == b.law.kind && first.stops == second.stops &&
         first.system.index() == second.system.index();
}

RigLanes::RigLanes(Tolerances tolerances, const OutputGrid& grid, const LaneAsked& asked)
    : LaneEngine(tolerances),
      grid_(grid),
      asked_(asked),
      reference_(std::make_unique<LaneReference>()),
      controllers_(kernels_) {
  scene_.gimbal = asked.gimbal;
  scene_.reference = asked.reference;
}

void RigLanes::begin(std::size_t l, const model::Model& model, LaneSink& sink) {
  Lane& lane = lanes_[l];
  open(l, model, grid_.end(), false);
  lane.run->sampling()->share_reference(shared_reference_);
  feeds_servos_back_[l] = model.rig->sampled->law.feeds_servos_back();
  next_row_[l] = 0;
  lane.run->handle_time_event(0, lane.z.data());
  controllers_.take_over(l, lane.run->sampling()->controller());
  const std::vector<char>& occurring = lane.run->occurring();
  lane.alive = lane.run->check_events(0, lane.z.data()) == model::Effect::none &&
               std::find(occurring.begin(), occurring.end(), 1) == occurring.end();
  pass_row(l, sink);
  start(l);
}

// Evaluates the reference at the start and all nodes but the first.
void RigLanes::fill_reference() {
  LaneReference& reference = *reference_;
  std::size_t last = group;  // the lane whose piece reference.common is for
  reference.shared = true;
  for (std::size_t l = 0; l < group; ++l) {
    if (!step_.has_[l]) continue;
    const bool known = last < group && step_.from_[l] == step_.from_[last] &&
                       pieces_->length[l] == pieces_->length[last];
    if (known) continue;
    reference.shared = last == group;
    if (!reference.shared) break;
    take_reference(l);
    last = l;
  }
  if (reference.shared) return;
  for (std::size_t l = 0; l < group; ++l) {
    if (!step_.has_[l]) continue;
    take_reference(l);
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t n = 0; n < nodes; ++n) reference.at[i][n][l] = reference.common[i][n];
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
  if (asked_.reference) fill_reference();
  kernels_.evaluate_quantities(*pieces_, scene_, *reference_, step_.quantities_);
  for (std::size_t l = 0; l < group; ++l) {
    if (!step_.has_[l] || is_quiet(l) || !has_event(l)) continue;
    lanes_[l].alive = lanes_[l].moved = step_.has_[l] = false;
  }
}

std::vector<double> RigLanes::whole_row(std::size_t l, double t) const {
  const Lane& lane = lanes_[l];
  std::vector<double> row(lane.run->model().row_size());
  const std::size_t size = lane.run->model().size();
  std::copy_n(lane.z.begin(), size, row.begin());
  lane.run->write_extras(t, lane.z.data(), row.data() + size);
  return row;
}

// Passes on the next row of a lane, which has its state.
void RigLanes::pass_row(std::size_t l, LaneSink& sink) {
  const std::size_t row = next_row_[l]++;
  sink.accept_row(l, row, lanes_[l].z[0], lanes_[l].z[1]);
  if (asked_.rows) sink.accept_whole(l, whole_row(l, grid_[row]));
}

// Takes samples, applies commands and passes rows on, each at its time, up to the ends of the
// pieces.
void RigLanes::pass_instants(LaneSink& sink) {
  const auto row_time = [this](std::size_t l) { return grid_[next_row_[l]]; };
  NextInstants next;
  while (find_instants(row_time, next)) {
    for (std::size_t l = 0; l < group; ++l) {
      Lane& lane = lanes_[l];
      if (!lane.moved || lane.settled) continue;
      const double t = next.when[l];
      const bool last = grid_.end() - t <= lane.run->rounding(t);
      const bool is_row = asked_.rows && grid_[next_row_[l]] - t <= lane.run->rounding(t);
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
        pass_row(l, sink);
      }
      if (next_row_[l] == grid_.size()) {
        sink.accept_end(l, grid_.end(), whole_row(l, grid_.end()));
        lane.alive = lane.moved = false;
      } else if (lane.restarts) {
        lane.until = t;
      }
    }
  }
}

std::array<bool, group> RigLanes::integrate(const model::Model* const* models, std::size_t count,
                                            LaneSink& sink, const std::atomic<bool>& stop) {
  scene_.force = false;
  controllers_.begin();
  shared_reference_ = {};
  make_room(*models[0]);
  for (std::size_t l = 0; l < group; ++l) {
    if (l < count) {
      begin(l, *models[l], sink);
    } else {
      lanes_[l].alive = lanes_[l].moved = false;
    }
  }
  const auto limit_of = [](const Lane& lane) { return lane.run->next_change(); };
  while (!stop.load(std::memory_order_relaxed) && plan(limit_of)) {
    kernels_.attempt(*pieces_, scene_);
    judge();
    evaluate_quantities();
    sink.accept(step_);
    pass_instants(sink);
    for (std::size_t l = 0; l < group; ++l) {
      if (lanes_[l].moved) go_on(l);
    }
  }
  std::array<bool, group> carried{};
  for (std::size_t l = 0; l < count; ++l) {
    carried[l] = next_row_[l] == grid_.size();
  }
  return carried;
}

}  // namespace bbsim::solve::sampled
