// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/hybrid/servos.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "model/hybrid/rig_energy.hpp"

namespace bbsim::model {

Servos::Servos(SwitchedModel& model) : model_(model) {
  const Rig& rig = model.rig();
  const ServoResponses responses = model.with_loop([](const auto& loop) { return loop.servo(); });
  bool switches = false;
  for (std::size_t i = 0; i < static_cast<std::size_t>(rig.servos); ++i) {
    // With backlash, the plane starts at rest in the middle of the gap.
    if (rig.servo[i].backlash > 0) model.mode().axis[i].ratio = 0;
    switches = switches || rig.servo[i].switches();
    RigMode& mode = model.mode();
    mode.rings = mode.rings || rig.servo[i].rings;
    mode.lags = mode.rings || mode.lags || rig.servo[i].torque_limit < unlimited;
    mode.driver[i].angle = model.get().initial[SwitchedModel::angle + i];
    mode.driver[i].rate = model.get().initial[model.rate() + i];
    axes_.emplace_back(rig.servo[i], responses.of[i]);
  }
  if (switches) guards_ = axes_.size() * ServoAxis::guards;
}

void Servos::append_scales(std::vector<double>& scales) const {
  scales.resize(scales.size() + guards_);
  double* of = scales.data() + scales.size() - guards_;
  for (std::size_t g = 0; g < guards_; g += ServoAxis::guards) {
    axes_[g / ServoAxis::guards].scales(of + g);
  }
}

void Servos::evaluate(const GuardContext& now, double* values) const {
  if (guards_ == 0) return;
  for (std::size_t i = 0; i < axes_.size(); ++i, values += ServoAxis::guards) {
    axes_[i].evaluate(state(i, now.t, now.demands(), now.z), values);
  }
}

// A fast test for sampled rigs, whose servos mostly stay in their modes.
bool Servos::stay_free(const double* z) const {
  if (!model_.rig().sampled) return false;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    if (!axes_[i].stays_free(z[SwitchedModel::angle + i], z[model_.rate() + i])) return false;
  }
  return true;
}

bool Servos::reset(double t, double* z) {
  chose_ = !stay_free(z);
  if (!chose_) return false;
  const Demands demands = model_.demands(t, z);
  RigMode mode_before = model_.mode();
  std::array<double, CoupledLayout<most_servos>::states> z_before;
  std::copy_n(z, model_.get().size(), z_before.begin());
  bool jumped = false, moved = false;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    AxisState axis = state(i, t, demands, z);
    AxisMode& mode = model_.mode().axis[i];
    axes_[i].settle(axis, mode);
    if (model_.mode().lags && lags(i, axis, t)) continue;
    double& angle = z[SwitchedModel::angle + i];
    double& rate = z[model_.rate() + i];
    jumped = jumped || axis.angle != angle || axis.rate != rate;
    angle = axis.angle;
    rate = axis.rate;
    const AxisMode& before = mode_before.axis[i];
    moved = moved || mode.ratio != before.ratio || mode.offset != before.offset;
  }
  if (!jumped && !moved) return false;
  const RigExtras now = model_.plane(z);
  std::swap(model_.mode(), mode_before);
  const RigExtras before = model_.plane(z_before.data());
  std::swap(model_.mode(), mode_before);
  if (now.rate[0] == before.rate[0] && now.rate[1] == before.rate[1]) return jumped;
  kick_ball(z, z_before.data(), before, now);
  return true;
}

// Sets the driver of a stepper, which goes on from `axis`. Returns whether the shaft rings: it is
// then free, and does not jump.
bool Servos::lags(std::size_t i, const AxisState& axis, double t) {
  StepperDriver& driver = model_.mode().driver[i];
  driver.ratio = axes_[i].field().ratio;
  driver.offset = axes_[i].field().offset;
  if (!driver.rings) return false;
  AxisMode& mode = model_.mode().axis[i];
  driver.since = t;
  driver.angle = axis.angle;
  driver.rate = axis.rate;
  driver.acceleration = std::exchange(mode.set_acceleration, 0);
  mode.demand_factor = 1;
  return true;
}

// The ball's velocity jumps with the rates of the plane.
void Servos::kick_ball(double* z, const double* before, const RigExtras& plane_before,
                       const RigExtras& plane) {
  const auto kick = model_.with_loop([&](const auto& loop) {
    return loop.impulse(z, plane.rate[0] - plane_before.rate[0],
                        plane.rate[1] - plane_before.rate[1]);
  });
  for (std::size_t i = 0; i < 3; ++i) z[2 + i] += kick[i];
  if (!model_.get().work) return;
  // The servos apply the impulse that this takes. Its energy counts as their work.
  std::visit(
      [&](const auto& any) {
        using Any = std::decay_t<decltype(any)>;
        if constexpr (is_coupled_loop<Any>) {
          const CoupledBall& ball = any.parts.ball;
          z[Any::Layout::work] += energy_of(ball, z, plane) - energy_of(ball, before, plane_before);
        }
      },
      model_.get().system);
}

std::array<bool, most_servos> Servos::follow(const std::array<double, most_servos>& commands) {
  std::array<bool, most_servos> jumps{};
  RigMode& mode = model_.mode();
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const double follows = axes_[i].follow(commands[i]);
    jumps[i] = follows != mode.command[i];
    if (jumps[i]) mode.command[i] = follows;
  }
  return jumps;
}

HeldMotions Servos::held_motions(double t, const double* z) const {
  return model_.with_loop([&](const auto& loop) {
    HeldMotions motions;
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      motions[i] = held_motion(loop.servo().of[i], loop.mode, i, z[SwitchedModel::angle + i],
                               z[model_.rate() + i], t);
    }
    return motions;
  });
}

Crossing Servos::next_crossing(double t, const HeldMotions& motions, double end) {
  Crossing first;
  if (guards_ == 0) return first;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const StepperDriver& driver = model_.mode().driver[i];
    HeldMotion of_driver;
    if (driver.rings) {
      const Jet<double> counted = driver.counted(t);
      of_driver = {{}, counted.value, counted.rate, counted.acceleration};
    }
    const ServoAxis::Crossing next =
        axes_[i].first_crossing(driver.rings ? of_driver : motions[i], model_.mode().command[i], t,
                                std::min(end, first.time) - t, answers_);
    // Rounds up, so that the guard has crossed at that time even if the step is below the rounding
    // of t.
    double at = t + next.after;
    if (at - t < next.after) at = std::nextafter(at, unlimited);
    if (at < first.time) {
      first = {at, i * ServoAxis::guards + static_cast<std::size_t>(next.guard)};
    }
  }
  return first;
}

CurvePieces::CurvePieces(SwitchedModel& model) : model_(model) {
  for (std::size_t i = 0; i < 2; ++i) {
    if (linkage(i).table) pieces_[i] = command_pieces_[i] = linkage(i).piece_at(0, 0, 1);
  }
}

void CurvePieces::put() {
  auto& loop = std::get<CoupledLoop<SignalPair, Linkages>>(model_.get().system).loop;
  for (std::size_t i = 0; i < 2; ++i) {
    if (!linkage(i).table) continue;
    LinkCurve& curve = loop.link.of[i];
    curve.piece = linkage(i).table->view().pieces[pieces_[i]];
    curve.command_piece = linkage(i).table->view().pieces[command_pieces_[i]];
  }
}

void CurvePieces::choose(double t, const double* z) {
  const Demands demands = model_.demands(t, z);
  for (std::size_t i = 0; i < 2; ++i) {
    const Linkage& of = linkage(i);
    if (!of.table) continue;
    const AxisMode& axis = model_.mode().axis[i];
    const double horn = axis.ratio * z[SwitchedModel::angle + i] + axis.offset;
    pieces_[i] = of.piece_at(pieces_[i], horn, axis.ratio * z[model_.rate() + i]);
    if (converts_commands(of)) {
      command_pieces_[i] = of.command_piece_at(command_pieces_[i], demands.command[i]);
    }
  }
  put();
}

void CurvePieces::evaluate(const GuardContext& now, double* values) const {
  std::fill(values, values + guards(), unlimited);
  for (std::size_t i = 0; i < 2; ++i, values += Guard::count) {
    const Linkage& of = linkage(i);
    if (!of.table) continue;
    const AxisMode& axis = model_.mode().axis[i];
    const double horn = axis.ratio * now.z[SwitchedModel::angle + i] + axis.offset;
    const std::size_t last = of.table->knots().size() - 2;
    const CommandRange holds = of.piece_range(pieces_[i]);
    // The dead_point monitor handles the ends of the whole curve.
    if (pieces_[i] < last) values[Guard::high] = holds.high - horn;
    if (pieces_[i] > 0) values[Guard::low] = horn - holds.low;
    if (!converts_commands(of)) continue;
    const CommandRange command = of.command_piece_range(command_pieces_[i]);
    const bool rises = of.curve.slope > 0;
    const bool at_first = command_pieces_[i] == 0, at_last = command_pieces_[i] == last;
    const double wants = now.demands().command[i] + of.curve.shift;
    if (!(rises ? at_last : at_first)) values[Guard::command_high] = command.high - wants;
    if (!(rises ? at_first : at_last)) values[Guard::command_low] = wants - command.low;
  }
}

}  // namespace bbsim::model
