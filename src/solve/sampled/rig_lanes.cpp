// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solve/sampled/rig_lanes.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "model/model.hpp"
#include "solve/collocation/step_length.hpp"
#include "solve/sampled/sides.hpp"

namespace bbsim::solve::sampled {
namespace {

constexpr auto angle_state = static_cast<std::size_t>(model::RigLayout::angle);
constexpr auto rate_state = static_cast<std::size_t>(model::RigLayout::rate);

// A lane with more rejections is left to a single run, which can report why it fails.
constexpr int most_rejections = 40;

const model::RigLoop<false>& loop_of(const model::Model& model) {
  return std::get<model::RigLoop<false>>(model.system);
}

// Marks all motions as resolved by the nodes.
void lose_nothing(LaneAxis& axis) {
  axis.lost = false;
  for (double* const lost : {axis.lost_rate_by_rate, axis.lost_rate_by_acceleration,
                             axis.lost_angle_by_rate, axis.lost_angle_by_acceleration}) {
    std::fill_n(lost, group, 0.0);
  }
}

}  // namespace

bool carries(const model::Model& model) {
  return knows(model) && !model.rig->sampled->external &&
         model.rig->sampled->law.kind != model::LawKind::held && !model.gamma &&
         loop_of(model).rolling() == model::GeneralRolling{};
}

bool go_together(const model::Model& one, const model::Model& other) {
  const model::SampledLoop &a = *one.rig->sampled, &b = *other.rig->sampled;
  return a.law.kind == b.law.kind && one.stops == other.stops;
}

Range LaneStep::bounds(Size size, std::size_t lane) const {
  const Range range = lane_kernels_->look_closely(looks_, size, static_cast<int>(lane));
  const double beyond = close_overshoot * (range.most - range.least);
  return {range.least - beyond, range.most + beyond};
}

// The motion of a lane's servo from the start of its piece.
model::HeldMotion LaneStep::servo(std::size_t lane, std::size_t i) const {
  const LaneServo& servo = servos_->of[i];
  const LaneAxis& axis = pieces_->axis[i];
  return {{servo.stiffness[lane], servo.damping[lane]},
          axis.angle[lane],
          axis.rate[lane],
          axis.acceleration[lane]};
}

void LaneStep::evaluate(std::size_t lane, const double* times, std::size_t count,
                        Track* track) const {
  const LanePieces& of = *pieces_;
  Piece piece;
  for (int i = 0; i < 3; ++i) {
    for (int n = 0; n < nodes; ++n) piece.series[i][n] = of.series[i][n][lane];
    piece.velocity[i] = of.velocity[i][lane];
    piece.position[i] = i < 2 ? of.position[i][lane] : 0;
  }
  piece.length = of.length[lane];
  const model::HeldMotion servos[2] = {servo(lane, 0), servo(lane, 1)};
  constexpr std::size_t together = 16;
  double after[together], ball[together][6];
  for (std::size_t first = 0; first < count; first += together) {
    const std::size_t some = std::min(together, count - first);
    for (std::size_t i = 0; i < some; ++i) after[i] = times[first + i] - from_[lane];
    kernels_->evaluate(piece, after, some, ball);
    for (std::size_t i = 0; i < some; ++i) {
      Track& at = track[first + i];
      at.x = ball[i][0];
      at.y = ball[i][1];
      double plane[2], turns[2];
      const model::ImpulseAnswer answer = model::answer(servos[0].law, after[i]);
      for (std::size_t k = 0; k < 2; ++k) {
        const bool alike = servos[k].law == servos[0].law;
        const model::HeldMotion::Instant now =
            alike ? servos[k].after(answer) : servos[k].after(after[i]);
        const LaneAxis& axis = of.axis[k];
        plane[k] = axis.ratio[lane] * now.angle + axis.offset[lane];
        turns[k] = axis.ratio[lane] * now.rate;
      }
      at.phi = plane[0];
      at.theta = plane[1];
      at.phi_rate = turns[0];
      at.theta_rate = turns[1];
    }
  }
}

RigLanes::RigLanes(Tolerances tolerances, const OutputGrid& grid, const LaneAsked& asked)
    : tolerances_(tolerances),
      grid_(grid),
      asked_(asked),
      kernels_(choose_lane_kernels()),
      pieces_(std::make_unique<LanePieces>()),
      servos_(std::make_unique<LaneServos>()),
      reference_(std::make_unique<LaneReference>()),
      controllers_(kernels_) {
  scene_.rtol = tolerances.rtol;
  scene_.atol = tolerances.atol;
  scene_.gimbal = asked.gimbal;
  scene_.reference = asked.reference;
  step_.pieces_ = pieces_.get();
  step_.servos_ = servos_.get();
  step_.kernels_ = &choose_kernels();
  step_.lane_kernels_ = &kernels_;
}

void RigLanes::begin(std::size_t l, const model::Model& model, LaneSink& sink) {
  Lane& lane = lanes_[l];
  lane.run.emplace(model, tolerances_.atol);
  lane.run->sampling()->share_reference(shared_reference_);
  lane.feeds_servos_back = model.rig->sampled->law.feeds_servos_back();
  lane.instants.emplace(*model.rig->sampled);
  std::copy(model.initial.begin(), model.initial.end(), lane.z.begin());
  lane.time = 0;
  lane.next_step = std::numeric_limits<double>::infinity();
  lane.next_row = 1;
  lane.rejections = 0;
  lane.standstill = {};
  lane.run->handle_time_event(0, lane.z.data());
  controllers_.take_over(l, lane.run->sampling()->controller());
  const std::vector<char>& occurring = lane.run->occurring();
  lane.alive = lane.run->check_events(0, lane.z.data()) == model::Effect::none &&
               std::find(occurring.begin(), occurring.end(), 1) == occurring.end();
  scene_.radius[l] = model.radius;
  scene_.gravity[l] = loop_of(model).gravity();
  take_monitors(l, model);
  clear(l);
  sink.accept_row(l, 0, lane.z[0], lane.z[1]);
  take_mode(l);
  put_start(l);
  lane.unpredicted = true;
}

void RigLanes::take_monitors(std::size_t l, const model::Model& model) {
  scene_.friction[l] = 0;
  for (std::size_t look = 0; look <= Look::grip; ++look) {
    scene_.least[look][l] = -model::unlimited;
    scene_.most[look][l] = model::unlimited;
  }
  if (!model.events) return;
  for (const model::Monitor& monitor : model.events->monitors) {
    using Kind = model::Monitor::Kind;
    if (monitor.kind == Kind::slip) scene_.friction[l] = monitor.limit;
    if (monitor.kind == Kind::slip || monitor.kind == Kind::lift_off) scene_.force = true;
    const auto stays = [&](Look look, double least, double most) {
      scene_.least[look][l] = std::max(scene_.least[look][l], least);
      scene_.most[look][l] = std::min(scene_.most[look][l], most);
    };
    // No value is within this range, so the lane is given up.
    if (!for_each_side(monitor, model.events->plate, stays)) {
      stays(Look::x, model::unlimited, -model::unlimited);
    }
  }
}

// Puts harmless numbers into a lane without a rig, or with one that was given up.
void RigLanes::clear(std::size_t l) {
  for (std::size_t i = 0; i < 3; ++i) {
    pieces_->velocity[i][l] = pieces_->guess[i][l] = 0;
    if (i == 2) continue;
    LaneAxis& axis = pieces_->axis[i];
    pieces_->position[i][l] = axis.angle[l] = axis.rate[l] = axis.acceleration[l] = 0;
    axis.ratio[l] = axis.offset[l] = 0;
    LaneServo& servo = servos_->of[i];
    servo.push[l] = servo.by_command[l] = servo.stiffness[l] = servo.damping[l] = 0;
  }
  pieces_->contraction[l] = 1e-2;
}

void RigLanes::take_commands(std::size_t l) {
  const model::RigMode& mode = loop_of(lanes_[l].run->model()).mode;
  for (std::size_t i = 0; i < 2; ++i) servos_->of[i].command[l] = mode.command[i];
}

void RigLanes::take_mode(std::size_t l) {
  take_commands(l);
  const model::HybridSystem& run = *lanes_[l].run;
  const Loop& loop = loop_of(run.model());
  for (std::size_t i = 0; i < 2; ++i) {
    const model::AxisMode& mode = loop.mode.axis[i];
    const model::ServoResponse& response = loop.servo().of[i];
    LaneServo& servo = servos_->of[i];
    const double free = mode.demand_factor;
    servo.push[l] = mode.set_acceleration;
    servo.by_command[l] = free * response.from_command;
    servo.stiffness[l] = free * response.from_angle;
    servo.damping[l] = free * response.from_rate;
    const model::ServoAxis::Clearance clear = run.servos()->axis(i).clearance();
    servo.angle_most[l] = clear.angle;
    servo.rate_most[l] = clear.rate;
    servo.acceleration_most[l] = clear.acceleration;
    servo.root[l] = clear.root;
    servo.inverse_root[l] = clear.root > 0 ? 1 / clear.root : 0;
    pieces_->axis[i].ratio[l] = mode.ratio;
    pieces_->axis[i].offset[l] = mode.offset;
  }
}

// Makes a lane's state the start of its next piece.
void RigLanes::put_start(std::size_t l) {
  const Lane& lane = lanes_[l];
  for (std::size_t i = 0; i < 3; ++i) {
    pieces_->velocity[i][l] = lane.z[2 + i];
    if (i == 2) continue;
    pieces_->position[i][l] = lane.z[i];
    pieces_->axis[i].angle[l] = lane.z[angle_state + i];
    pieces_->axis[i].rate[l] = lane.z[rate_state + i];
  }
}

void RigLanes::predict_crossing(std::size_t l) {
  Lane& lane = lanes_[l];
  lane.unpredicted = false;
  lane.predicted_to = lane.run->next_change();
  lane.crossing = {};
  if (servos_->clear[l] != 0) return;
  lane.crossing = lane.run->servos()->next_crossing(
      lane.time, {step_.servo(l, 0), step_.servo(l, 1)}, lane.predicted_to);
}

// Finds the motion of the servos of an axis over the pieces. Mostly all lanes share one table.
void RigLanes::load_tables(std::size_t i) {
  const LaneServo& servo = servos_->of[i];
  LaneAxis& axis = pieces_->axis[i];
  std::size_t one = group;
  bool alike = true;
  for (std::size_t l = 0; l < group; ++l) {
    if (!(pieces_->length[l] > 0)) continue;
    if (one == group) one = l;
    alike = alike && pieces_->length[l] == pieces_->length[one] &&
            servo.stiffness[l] == servo.stiffness[one] && servo.damping[l] == servo.damping[one];
  }
  if (one == group) return;
  const auto asked_of = [&](std::size_t l) {
    return Loaded{{servo.stiffness[l], servo.damping[l]}, pieces_->length[l]};
  };
  const auto put = [&axis](const MotionTable& table, std::size_t l) {
    axis.most_by_rate[l] = table.most_by_rate;
    axis.most_by_acceleration[l] = table.most_by_acceleration;
    axis.missed_by_rate[l] = table.missed_by_rate;
    axis.missed_by_acceleration[l] = table.missed_by_acceleration;
    axis.lost = axis.lost || table.lost;
    axis.lost_rate_by_rate[l] = table.lost_rate_by_rate;
    axis.lost_rate_by_acceleration[l] = table.lost_rate_by_acceleration;
    axis.lost_angle_by_rate[l] = table.lost_angle_by_rate;
    axis.lost_angle_by_acceleration[l] = table.lost_angle_by_acceleration;
  };
  if (alike) {
    const Loaded asked = asked_of(one);
    if (axis.shared != nullptr && shared_[i] == asked) return;
    shared_[i] = asked;
    shared_tables_[i] = lanes_[one].tables.of(asked.law, asked.length);
    axis.shared = &shared_tables_[i];
    axis.lost = false;
    for (std::size_t l = 0; l < group; ++l) put(shared_tables_[i], l);
    return;
  }
  if (axis.shared != nullptr) loaded_[i].fill({});
  axis.shared = nullptr;
  std::array<Loaded, group> asked;
  bool known = true, suits = true;
  for (std::size_t l = 0; l < group; ++l) {
    asked[l] = asked_of(l);
    if (!(asked[l].length > 0)) continue;
    known = known && loaded_[i][l] == asked[l];
    suits = suits && model::suits_series(asked[l].law, asked[l].length);
  }
  if (known) return;
  if (suits) {
    kernels_.tables(axis, servo, pieces_->length);
    if (axis.lost) lose_nothing(axis);
    loaded_[i] = asked;
    return;
  }
  for (std::size_t l = 0; l < group; ++l) {
    if (!(asked[l].length > 0) || loaded_[i][l] == asked[l]) continue;
    loaded_[i][l] = asked[l];
    const MotionTable& table = lanes_[l].tables.of(asked[l].law, asked[l].length);
    put(table, l);
    for (int row = 0; row < MotionTable::rows; ++row) {
      for (int n = 0; n < nodes; ++n) {
        axis.by_rate[row][n][l] = table.by_rate[row][n];
        axis.by_acceleration[row][n][l] = table.by_acceleration[row][n];
      }
    }
  }
}

// Plans a piece for each lane. Returns false if no lane is left.
bool RigLanes::plan() {
  bool any = false;
  kernels_.start(*pieces_, *servos_);
  for (std::size_t l = 0; l < group; ++l) {
    Lane& lane = lanes_[l];
    any = any || lane.alive;
    lane.moved = lane.alive;
    lane.restarts = lane.switched = lane.settled = false;
    pieces_->length[l] = 0;
    if (!lane.alive) clear(l);
    if (!lane.moved) continue;
    if (lane.unpredicted) predict_crossing(l);
    const double limit = std::min(lane.run->next_change(), lane.crossing.time);
    const double left = limit - lane.time;
    if (!(left > 0)) {  // two guards cross zero at one instant: nothing moves
      lane.until = lane.time;
      if (++lane.rejections > most_rejections) lane.alive = lane.moved = false;
      continue;
    }
    const Stride next = stride(left, lane.next_step);
    lane.step = next.length;
    lane.until = next.arrives ? limit : lane.time + lane.step;
    pieces_->length[l] = lane.instants->nominal(lane.time, lane.step);
  }
  for (std::size_t i = 0; i < 2; ++i) load_tables(i);
  return any;
}

// Accepts the pieces that are accurate enough, and shortens the others.
void RigLanes::judge() {
  for (std::size_t l = 0; l < group; ++l) {
    Lane& lane = lanes_[l];
    step_.has_[l] = lane.moved && pieces_->length[l] > 0;
    if (!step_.has_[l]) continue;
    constexpr double most_growth = 8;
    double error = pieces_->error[l];
    const bool solved = error < hopeless;
    const bool arrives = lane.until >= std::min(lane.run->next_change(), lane.crossing.time);
    // A step that its limit cut short says little about the length of the next.
    const bool tells = !arrives || lane.rejections > 0 || lane.next_step < most_growth * lane.step;
    if (solved && (error > 1 || tells)) {
      error = kernels_.closer_error(*pieces_, scene_, static_cast<int>(l));
    }
    if (!solved || !(error <= 1)) {
      lane.next_step = lane.step * (solved ? std::min(0.9, step_growth(error, nodes)) : 0.2);
      lane.moved = step_.has_[l] = false;
      if (++lane.rejections > most_rejections) lane.alive = false;
      continue;
    }
    if (tells) {
      const double factor = step_growth(error, nodes);
      const double next = lane.step * (lane.rejections > 0 ? std::min(factor, 1.0) : factor);
      lane.next_step = arrives && lane.rejections == 0 ? std::max(next, lane.next_step) : next;
    }
    lane.rejections = 0;
    step_.from_[l] = lane.time;
    step_.whole_[l] = lane.until <= grid_.end();
    const model::Model& model = lane.run->model();
    const double to = model.jumps_at(lane.until) ? model.just_before(lane.until) : lane.until;
    step_.to_[l] = std::min(to, grid_.end());
  }
}

// Evaluates the reference at the start and all nodes but the first.
void RigLanes::fill_reference() {
  LaneReference& reference = *reference_;
  std::size_t last = group;  // the lane whose piece reference.one is for
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
      for (std::size_t n = 0; n < nodes; ++n) reference.at[i][n][l] = reference.one[i][n];
    }
  }
}

void RigLanes::take_reference(std::size_t l) {
  const model::Model& model = lanes_[l].run->model();
  const auto view = loop_of(model).reference().view();
  // Until it jumps, the reference is constant.
  const bool jumps = model.jumps_at(lanes_[l].until);
  const double length = jumps ? step_.to_[l] - step_.from_[l] : pieces_->length[l];
  kernels_.reference(view, step_.from_[l], length, reference_->one);
}

void RigLanes::look() {
  if (asked_.reference) fill_reference();
  kernels_.look(*pieces_, scene_, *reference_, step_.looks_);
  for (std::size_t l = 0; l < group; ++l) {
    if (!step_.has_[l] || step_.looks_.quiet[l] != 0) continue;
    lanes_[l].alive = lanes_[l].moved = step_.has_[l] = false;
  }
}

// Sets the state at t within a lane's piece, or at its end. `ball` must hold the balls at t. Sets
// the servos' states if `servos`, and always at the end.
void RigLanes::state_at(std::size_t l, double t, const double (*ball)[group], bool servos) {
  Lane& lane = lanes_[l];
  if (pieces_->length[l] == 0) return;  // the state is unchanged
  const bool at_end = t >= lane.until;
  for (std::size_t i = 0; i < 3; ++i) {
    lane.z[2 + i] = at_end ? pieces_->velocity_end[i][l] : ball[2 + i][l];
    if (i < 2) lane.z[i] = at_end ? pieces_->position_end[i][l] : ball[i][l];
  }
  if (!servos && !at_end) return;
  for (std::size_t i = 0; i < 2; ++i) {
    const LaneAxis& axis = pieces_->axis[i];
    if (at_end) {
      lane.z[angle_state + i] = axis.angle_end[l];
      lane.z[rate_state + i] = axis.rate_end[l];
    } else {
      const model::HeldMotion servo = step_.servo(l, i);
      const model::HeldMotion::Instant at =
          servo.after(lane.instants->answer(servo.law, lane.until, t - lane.time));
      lane.z[angle_state + i] = at.angle;
      lane.z[rate_state + i] = at.rate;
    }
  }
}

void RigLanes::end_lane(std::size_t l, double t, LaneSink& sink) {
  Lane& lane = lanes_[l];
  std::vector<double> row(lane.run->model().row_size());
  std::copy(lane.z.begin(), lane.z.end(), row.begin());
  lane.run->write_extras(t, lane.z.data(), row.data() + size);
  sink.accept_end(l, t, row);
  lane.alive = false;
}

// Takes samples, applies commands and hands on rows, each at its time, up to the ends of the
// pieces.
void RigLanes::pass_instants(LaneSink& sink) {
  alignas(64) double after[group], ball[5][group];
  double when[group];
  bool is_event[group];
  for (;;) {
    bool any = false, within = false;
    for (std::size_t l = 0; l < group; ++l) {
      Lane& lane = lanes_[l];
      after[l] = 0;
      if (!lane.moved || lane.settled) continue;
      const double due = lane.run->next_time_event(), row = grid_[lane.next_row];
      is_event[l] = !(row < due - lane.run->rounding(due));
      when[l] = is_event[l] ? due : row;
      // A sample and a command at one instant may differ by rounding. The command's time counts.
      if (is_event[l] && lane.run->changes_at(due)) when[l] = lane.run->next_change();
      const double last = lane.until + (is_event[l] ? 0 : lane.run->rounding(lane.until));
      if (when[l] > last) {
        lane.settled = true;
        continue;
      }
      any = true;
      if (when[l] >= lane.until) continue;
      after[l] = when[l] - lane.time;
      within = true;
    }
    if (!any) return;
    if (within) kernels_.evaluate(*pieces_, after, ball);
    for (std::size_t l = 0; l < group; ++l) {
      Lane& lane = lanes_[l];
      if (!lane.moved || lane.settled) continue;
      const double t = when[l];
      const bool last = grid_.end() - t <= lane.run->rounding(t);
      state_at(l, t, ball, (is_event[l] && lane.feeds_servos_back) || last);
      if (!is_event[l]) continue;
      lane.run->observe(t, lane.z.data());
      if (lane.run->samples_at(t)) controllers_.sample(l, *lane.run, t, lane.z.data());
    }
    controllers_.finish();
    for (std::size_t l = 0; l < group; ++l) {
      Lane& lane = lanes_[l];
      if (!lane.moved || lane.settled) continue;
      const double t = when[l];
      if (is_event[l]) {
        lane.run->act(t, lane.z.data());
        lane.restarts = lane.settled = lane.run->touched();
        lane.switched = lane.switched || !lane.run->only_commanded();
      }
      while (lane.next_row < grid_.size() &&
             grid_[lane.next_row] - t <= (is_event[l] ? lane.run->rounding(t) : 0)) {
        sink.accept_row(l, lane.next_row++, lane.z[0], lane.z[1]);
      }
      if (lane.next_row == grid_.size()) {
        end_lane(l, grid_.end(), sink);
        lane.moved = false;
      } else if (lane.restarts) {
        lane.until = t;
      }
    }
  }
}

// Continues from the end of a lane's piece.
void RigLanes::go_on(std::size_t l) {
  Lane& lane = lanes_[l];
  if (pieces_->length[l] > 0) {
    for (std::size_t i = 0; i < 3; ++i) {
      pieces_->guess[i][l] = pieces_->acceleration_at[i][nodes - 1][l];
    }
  }
  if (!lane.restarts) {
    state_at(l, lane.until, nullptr, true);
    if (lane.until >= lane.crossing.time) {
      lane.run->handle_state_event(lane.crossing.guard, lane.until, lane.z.data());
      lane.restarts = lane.switched = true;
    }
  }
  lane.time = lane.until;
  if (lane.switched && lane.standstill.after(lane.time)) lane.alive = false;
  if (lane.run->unsettled()) lane.alive = false;
  put_start(l);
  if (lane.switched) {
    take_mode(l);
  } else if (lane.restarts) {
    take_commands(l);
  }
  lane.unpredicted = lane.restarts || lane.predicted_to < lane.run->next_change();
}

std::array<bool, group> RigLanes::integrate(const model::Model* const* models, std::size_t count,
                                            LaneSink& sink, const std::atomic<bool>& stop) {
  scene_.force = false;
  controllers_.begin();
  shared_reference_ = {};
  for (std::size_t l = 0; l < group; ++l) {
    if (l < count) {
      begin(l, *models[l], sink);
    } else {
      lanes_[l].alive = lanes_[l].moved = false;
    }
  }
  while (!stop.load(std::memory_order_relaxed) && plan()) {
    kernels_.attempt(*pieces_, scene_);
    judge();
    look();
    sink.accept(step_);
    pass_instants(sink);
    for (std::size_t l = 0; l < group; ++l) {
      if (lanes_[l].moved) go_on(l);
    }
  }
  std::array<bool, group> carried{};
  for (std::size_t l = 0; l < count; ++l) {
    carried[l] = lanes_[l].next_row == grid_.size();
  }
  return carried;
}

}  // namespace bbsim::solve::sampled
