// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solve/sampled/lane_engine.hpp"

#include <bit>
#include <cmath>

#include "simd/instruction_set.hpp"
#include "solve/collocation/step_length.hpp"
#include "solve/sampled/monitor_ranges.hpp"

namespace bbsim::solve::sampled {
namespace {

constexpr auto angle_state = static_cast<std::size_t>(model::RigLayout::angle);

// A lane with more rejections is left to a single run, which can report why it fails.
constexpr int most_rejections = 40;

// Marks all motions as resolved by the nodes.
void lose_nothing(LaneAxis& axis) {
  axis.lost = false;
  for (double* const lost : {axis.lost_rate_by_rate, axis.lost_rate_by_acceleration,
                             axis.lost_angle_by_rate, axis.lost_angle_by_acceleration}) {
    std::fill_n(lost, group, 0.0);
  }
}

// Sets what the error estimate needs of a table.
void put(const MotionTable& table, LaneAxis& axis, std::size_t l) {
  axis.most_by_rate[l] = table.most_by_rate;
  axis.most_by_acceleration[l] = table.most_by_acceleration;
  axis.missed_by_rate[l] = table.missed_by_rate;
  axis.missed_by_acceleration[l] = table.missed_by_acceleration;
  axis.lost = axis.lost || table.lost;
  axis.lost_rate_by_rate[l] = table.lost_rate_by_rate;
  axis.lost_rate_by_acceleration[l] = table.lost_rate_by_acceleration;
  axis.lost_angle_by_rate[l] = table.lost_angle_by_rate;
  axis.lost_angle_by_acceleration[l] = table.lost_angle_by_acceleration;
}

}  // namespace

const LaneKernels& choose_lane_kernels() {
  return simd::kernels_by([](auto isa) -> const auto& { return lane_kernels<decltype(isa)>(); });
}

bool fits_lanes(const model::Model& model) {
  return can_step(model) && !model.gamma && !counts_work(model) && !model.rig->sampled->legs &&
         !model.rig->rings();
}

LaneEngine::LaneEngine(Tolerances tolerances)
    : tolerances_(tolerances),
      kernels_(choose_lane_kernels()),
      pieces_(std::make_unique<LanePieces>()),
      servos_(std::make_unique<LaneServos>()) {
  scene_.rtol = tolerances.rtol;
  scene_.atol = tolerances.atol;
  step_.pieces_ = pieces_.get();
  step_.servos_ = servos_.get();
  step_.kernels_ = &choose_kernels();
  step_.lane_kernels_ = &kernels_;
  pieces_->servos = 2;
  std::fill_n(pieces_->gain, group, 1.0);
}

bool LaneEngine::has_room(const model::Model& model) const {
  const bool direct = std::holds_alternative<model::RigLoop<false>>(model.system);
  return model.rig->servos == pieces_->servos && direct == (pieces_->plates == nullptr);
}

void LaneEngine::make_room(const model::Model& model) {
  scene_.papers = true;
  if (has_room(model)) return;
  const bool direct = std::holds_alternative<model::RigLoop<false>>(model.system);
  pieces_->plates = direct ? nullptr : plates_->data();
  pieces_->servos = model.rig->servos;
  if (direct) std::fill_n(pieces_->gain, group, 1.0);
  forget_tables();
}

void LaneEngine::open(std::size_t l, const model::Model& model, double end, bool cut) {
  Lane& lane = lanes_[l];
  lane.run.emplace(model, tolerances_.atol);
  lane.instants.emplace(*model.rig->sampled, cut);
  lane.plate.emplace(lane.run->model());
  searches_[l].reset();
  step_.rigs_[l] = {&lane.run->model(), lane.z.data()};
  std::copy(model.initial.begin(), model.initial.end(), lane.z.begin());
  lane.time = 0;
  lane.end = end;
  lane.steps = {};
  lane.standstill = {};
  lane.waits = false;
  scene_.radius[l] = model.radius;
  with_given_plate(model.system, [&](const auto& loop) {
    scene_.gravity[l] = loop.gravity();
    const auto numbers =
        std::bit_cast<std::array<double, rolling_numbers>>(model::GeneralRolling(loop.rolling()));
    for (std::size_t i = 0; i < numbers.size(); ++i) scene_.rolling[i][l] = numbers[i];
    scene_.papers = scene_.papers && loop.rolling() == model::GeneralRolling{};
  });
  take_monitors(l, model);
  clear(l);
}

void LaneEngine::start(std::size_t l) {
  take_mode(l);
  put_start(l);
  lanes_[l].unpredicted = true;
}

void LaneEngine::forget_tables() {
  for (LaneAxis& axis : pieces_->axis) axis.shared = nullptr;
  loaded_ = {};
}

void LaneEngine::take_monitors(std::size_t l, const model::Model& model) {
  scene_.friction[l] = 0;
  for (std::size_t quantity = 0; quantity <= Quantity::grip; ++quantity) {
    scene_.least[quantity][l] = -unlimited;
    scene_.most[quantity][l] = unlimited;
  }
  if (!model.events) return;
  for (const model::Monitor& monitor : model.events->monitors) {
    using Kind = model::Monitor::Kind;
    if (monitor.kind == Kind::slip) scene_.friction[l] = monitor.limit;
    if (monitor.kind == Kind::slip || monitor.kind == Kind::lift_off) scene_.force = true;
    const auto stays = [&](Quantity quantity, double least, double most) {
      scene_.least[quantity][l] = std::max(scene_.least[quantity][l], least);
      scene_.most[quantity][l] = std::min(scene_.most[quantity][l], most);
    };
    if (monitor.kind == Kind::dead_point) continue;  // is_quiet()
    // No value is within this range, so the lane is given up.
    if (!for_each_range(monitor, model.events->plate, stays)) {
      stays(Quantity::x, unlimited, -unlimited);
    }
  }
}

// Puts harmless numbers into a lane without a rig, or with one that was given up.
void LaneEngine::clear(std::size_t l) {
  for (std::size_t i = 0; i < 3; ++i) {
    pieces_->velocity[i][l] = pieces_->guess[i][l] = 0;
    if (i < 2) pieces_->position[i][l] = 0;
    LaneAxis& axis = pieces_->axis[i];
    axis.angle[l] = axis.rate[l] = axis.acceleration[l] = 0;
    axis.ratio[l] = axis.offset[l] = 0;
    LaneServo& servo = servos_->of[i];
    servo.push[l] = servo.by_command[l] = servo.stiffness[l] = servo.damping[l] = 0;
  }
  pieces_->contraction[l] = 1e-2;
}

void LaneEngine::take_commands(std::size_t l) {
  const model::RigMode& mode = lanes_[l].plate->mode();
  for (std::size_t i = 0; i < lanes_[l].plate->servos(); ++i)
    servos_->of[i].command[l] = mode.command[i];
}

void LaneEngine::take_mode(std::size_t l) {
  take_commands(l);
  const model::HybridSystem& run = *lanes_[l].run;
  const HeldPlate& plate = *lanes_[l].plate;
  for (std::size_t i = 0; i < plate.servos(); ++i) {
    const model::AxisMode& mode = plate.mode().axis[i];
    const model::ServoResponse& response = plate.response().of[i];
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
void LaneEngine::put_start(std::size_t l) {
  const Lane& lane = lanes_[l];
  for (std::size_t i = 0; i < 3; ++i) {
    pieces_->velocity[i][l] = lane.z[2 + i];
    if (i < 2) pieces_->position[i][l] = lane.z[i];
  }
  const std::size_t servos = lane.plate->servos();
  for (std::size_t i = 0; i < servos; ++i) {
    pieces_->axis[i].angle[l] = lane.z[angle_state + i];
    pieces_->axis[i].rate[l] = lane.z[angle_state + servos + i];
  }
}

void LaneEngine::predict_crossing(std::size_t l) {
  Lane& lane = lanes_[l];
  lane.unpredicted = false;
  lane.predicted_to = lane.run->next_change();
  lane.crossing = {};
  if (servos_->clear[l] != 0) return;
  lane.crossing = lane.run->servos()->next_crossing(lane.time, step_.servos(l), lane.predicted_to);
}

// Finds the motion of the servos of an axis over the pieces. Usually all lanes share one table.
void LaneEngine::load_tables(std::size_t i) {
  const LaneServo& servo = servos_->of[i];
  LaneAxis& axis = pieces_->axis[i];
  std::size_t first = group;
  bool alike = true;
  for (std::size_t l = 0; l < group; ++l) {
    if (!(pieces_->length[l] > 0)) continue;
    if (first == group) first = l;
    alike = alike && pieces_->length[l] == pieces_->length[first] &&
            servo.stiffness[l] == servo.stiffness[first] &&
            servo.damping[l] == servo.damping[first];
  }
  if (first == group) return;
  const auto asked_of = [&](std::size_t l) {
    return Loaded{{servo.stiffness[l], servo.damping[l]}, pieces_->length[l]};
  };
  if (alike) {
    const Loaded asked = asked_of(first);
    if (axis.shared != nullptr && shared_[i] == asked) return;
    shared_[i] = asked;
    shared_tables_[i] = lanes_[first].tables.of(asked.law, asked.length);
    axis.shared = &shared_tables_[i];
    axis.lost = false;
    for (std::size_t l = 0; l < group; ++l) put(shared_tables_[i], axis, l);
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
    put(table, axis, l);
    for (int row = 0; row < MotionTable::rows; ++row) {
      for (int n = 0; n < nodes; ++n) {
        axis.by_rate[row][n][l] = table.by_rate[row][n];
        axis.by_acceleration[row][n][l] = table.by_acceleration[row][n];
      }
    }
  }
}

// Prepares the plates behind mechanisms.
void LaneEngine::load_plates() {
  for (LaneAxis& axis : pieces_->axis) axis.lost = false;
  for (std::size_t l = 0; l < group; ++l) {
    if (!(pieces_->length[l] > 0)) continue;
    Lane& lane = lanes_[l];
    PlateMotion& motion = pieces_->plates[l];
    lane.plate->prepare(step_.servos(l), pieces_->length[l], lane.tables, motion);
    std::array<double, LaneStep::most_states> end;
    lane.plate->write_end(motion, end.data());
    const std::size_t servos = lane.plate->servos();
    for (std::size_t i = 0; i < servos; ++i) {
      LaneAxis& axis = pieces_->axis[i];
      put(*motion.axis[i].table, axis, l);
      axis.angle_end[l] = end[angle_state + i];
      axis.rate_end[l] = end[angle_state + servos + i];
    }
  }
}

bool LaneEngine::is_quiet(std::size_t l) const {
  if (step_.quantities_.quiet[l] == 0) return false;
  return pieces_->plates == nullptr || lanes_[l].plate->stays_off_dead_points(
                                           pieces_->plates[l], step_.servos(l), pieces_->length[l]);
}

GuardSearch& LaneEngine::search_in(std::size_t l) {
  if (!motions_[l]) motions_[l].emplace(step_, l);
  if (!searches_[l]) {
    searches_[l].emplace(*lanes_[l].run, *motions_[l]);
    searches_[l]->after_switch();
  }
  return *searches_[l];
}

bool LaneEngine::has_event(std::size_t l) {
  GuardSearch& search = search_in(l);
  search.after_switch();
  search.begin_step();
  return search.begin(lanes_[l].time, step_.to(l)) == model::Effect::stop || search.next();
}

void LaneEngine::plan_lane(std::size_t l, double limit) {
  Lane& lane = lanes_[l];
  lane.limit = limit;
  const double left = limit - lane.time;
  if (!(left > 0)) {  // two guards cross zero at one instant: nothing moves
    lane.until = lane.time;
    if (++lane.steps.rejections > most_rejections) lane.alive = lane.moved = false;
    return;
  }
  const Stride next = stride(left, lane.steps.next);
  lane.step = next.length;
  lane.until = next.arrives ? limit : lane.time + lane.step;
  pieces_->length[l] = lane.instants->nominal(lane.time, lane.step);
}

// Accepts the pieces that are accurate enough, and shortens the others.
void LaneEngine::judge() {
  for (std::size_t l = 0; l < group; ++l) {
    Lane& lane = lanes_[l];
    step_.has_[l] = lane.moved && pieces_->length[l] > 0;
    if (!step_.has_[l]) continue;
    const double error = pieces_->error[l];
    const bool solved = error < hopeless;
    const bool arrives = lane.until >= lane.limit;
    if (!solved || !(error <= 1)) {
      lane.steps.reject(lane.step, solved ? step_growth(error, nodes) : StepControl::unsolved);
      lane.moved = step_.has_[l] = false;
      if (lane.steps.rejections > most_rejections) lane.alive = false;
      continue;
    }
    const bool needs = lane.steps.needs_growth(lane.step, arrives);
    lane.steps.accept(lane.step, arrives, needs ? step_growth(error, nodes) : 1);
    step_.from_[l] = lane.time;
    const model::Model& model = lane.run->model();
    const double to = model.jumps_at(lane.until) ? model.just_before(lane.until) : lane.until;
    step_.to_[l] = std::min(to, lane.end);
  }
}

void LaneEngine::state_at(std::size_t l, double t, const double (*ball)[group], bool servos) {
  Lane& lane = lanes_[l];
  if (pieces_->length[l] == 0) return;  // the state is unchanged
  const bool at_end = t >= lane.until;
  for (std::size_t i = 0; i < 3; ++i) {
    lane.z[2 + i] = at_end ? pieces_->velocity_end[i][l] : ball[2 + i][l];
    if (i < 2) lane.z[i] = at_end ? pieces_->position_end[i][l] : ball[i][l];
  }
  if (!servos && !at_end) return;
  const std::size_t count = lane.plate->servos();
  for (std::size_t i = 0; i < count; ++i) {
    double& angle = lane.z[angle_state + i];
    double& rate = lane.z[angle_state + count + i];
    const LaneAxis& axis = pieces_->axis[i];
    if (at_end) {
      angle = axis.angle_end[l];
      rate = axis.rate_end[l];
    } else {
      const model::HeldMotion servo = step_.servo(l, i);
      const model::HeldMotion::ServoState at =
          servo.after(lane.instants->answer(servo.law, lane.until, t - lane.time), t - lane.time);
      angle = at.angle;
      rate = at.rate;
    }
  }
}

// Continues from the end of a lane's piece.
void LaneEngine::go_on(std::size_t l) {
  Lane& lane = lanes_[l];
  if (pieces_->length[l] > 0) {
    for (std::size_t i = 0; i < 3; ++i) {
      pieces_->guess[i][l] = pieces_->acceleration_at[i][nodes - 1][l];
    }
    if (pieces_->plates != nullptr) lane.plate->pass(pieces_->plates[l]);
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
  if (lane.run->unsettled() || lane.run->stops()) lane.alive = false;
  put_start(l);
  if (lane.switched) {
    take_mode(l);
  } else if (lane.restarts) {
    take_commands(l);
  }
  lane.unpredicted = lane.restarts || lane.predicted_to < lane.run->next_change();
}

}  // namespace bbsim::solve::sampled
