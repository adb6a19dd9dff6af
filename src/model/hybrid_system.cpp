// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/hybrid_system.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "base/archive.hpp"
#include "model/ball/dynamics.hpp"
#include "simd/gradient.hpp"

namespace bbsim::model {
namespace {

constexpr int servo_angle = RigLayout::angle;  // index of the first servo's angle in the states

// The energy of a rolling ball and of the bodies that turn with the plane, (M51), J.
double energy_of(const CoupledBall& ball, const double* z, const RigExtras& plane) {
  BallConstants constants{ball.r, ball.m, ball.g, false, ball.rolling};
  std::copy_n(ball.body.plate, 3, constants.plate_inertia.begin());
  constants.plate_imbalance = ball.body.imbalance;
  constants.ring_inertia = ball.body.ring;
  constants.rotor_inertia = ball.body.rotor;
  Sample sample;
  sample.ball = ball_motion<Shape::full>(RigLayout::unpack(z), ball.r);
  sample.gimbal = {plane.angle[0], plane.angle[1], plane.rate[0], plane.rate[1], 0, 0};
  const Dynamics now = dynamics(sample, constants);
  return now.energy() + now.gimbal_energy;
}

}  // namespace

template <class Use>
auto HybridSystem::with_loop(Use use) const {
  using Result = decltype(use(std::declval<const RigLoop<>&>()));
  // The most common rig first, because each sample calls this several times.
  if (const auto* const plain = std::get_if<RigLoop<>>(&model_.system)) return use(*plain);
  return std::visit(
      [&](const auto& any) -> Result {
        using Any = std::decay_t<decltype(any)>;
        if constexpr (is_rig<Any>) {
          return use(any);
        } else if constexpr (is_coupled_loop<Any>) {
          return use(any.loop);
        } else {
          throw std::logic_error("a rig of a scene without a controller");
        }
      },
      model_.system);
}

HybridSystem::Wanted HybridSystem::axes(double t, const double* z) const {
  return with_loop([&](const auto& loop) {
    const auto all = loop.axes(loop.inputs(t), z);
    Wanted wanted{{all.command.raw[0], all.command.raw[1]},
                  {all.command.value[0], all.command.value[1]},
                  {},
                  {}};
    for (int i = 0; i < std::decay_t<decltype(loop)>::servos; ++i) {
      wanted.told[i] = loop.told(all, i);
      wanted.demand[i] = all.demand[i];
    }
    return wanted;
  });
}

// The plane's angles and rates.
RigExtras HybridSystem::plane(const double* z) const {
  return with_loop([z](const auto& loop) {
    const double none[std::decay_t<decltype(loop)>::servos] = {};
    RigExtras plane{};
    loop.fill(z, none, plane);
    return plane;
  });
}

HybridSystem::HybridSystem(const Model& model, double resolution) : model_(model) {
  std::visit(
      [this](auto& any) {
        using Any = std::decay_t<decltype(any)>;
        if constexpr (is_rig<Any>) {
          mode_ = &any.mode;
        } else if constexpr (is_coupled_loop<Any>) {
          mode_ = &any.loop.mode;
        }
      },
      model_.system);
  pass_stops(-unlimited);
  if (model_.rig) {
    const Rig& rig = *model_.rig;
    rate_ = servo_angle + rig.servos;
    is_direct_ = rig.between.none();
    only_servos_settle_ = rig.sampled && !rig.limits_commands() && !rig.between.has_pieces();
    const ServoResponses servo = with_loop([](const auto& loop) { return loop.servo(); });
    for (int i = 0; i < rig.servos; ++i) {
      // With backlash, the plane starts at rest in the middle of the gap.
      if (rig.servo[i].backlash > 0) mode_->axis[i].ratio = 0;
      servos_.emplace_back(rig.servo[i], servo.of[i]);
    }
    switches_ = rig.switches();
    if (switches_) {
      for (int i = 0; i < rig.servos; ++i) {
        double scales[axis_guards];
        servos_[static_cast<std::size_t>(i)].scales(scales);
        const auto scale = [](double limit) {
          return std::abs(limit) < unlimited && limit != 0 ? std::abs(limit) : 1.0;
        };
        scales[axis_guards - 2] = i < 2 ? scale(rig.command_limit[i].high) : 1.0;
        scales[axis_guards - 1] = i < 2 ? scale(rig.command_limit[i].low) : 1.0;
        guard_scales_.insert(guard_scales_.end(), scales, scales + axis_guards);
      }
      if (rig.between.has_pieces()) {
        guard_scales_.insert(guard_scales_.end(), std::size_t{2} * piece_guards, 1.0);
        for (std::size_t i = 0; i < 2; ++i) {
          const Linkage& linkage = rig.between.linkages[i];
          if (linkage.table) pieces_[i] = command_pieces_[i] = linkage.piece_at(0, 0, 1);
        }
      }
    }
    if (rig.sampled) {
      sampled_.emplace(
          Sampled{{0, 0}, SampleExchange(*rig.sampled), SampledController(*rig.sampled)});
      only_commands_change_ = !model_.dry && std::holds_alternative<RigLoop<false>>(model_.system);
      if (rig.sampled->law.kind == LawKind::held && !rig.sampled->external) {
        throw std::logic_error("a run of a scene whose controller nobody has attached");
      }
      sampled_->own.assign(model_.own_columns().size(), std::numeric_limits<double>::quiet_NaN());
    }
  }
  if (model_.dry) {
    dry_.emplace(*model_.dry, resolution);
    dry_->append_scales(guard_scales_);
  }
  if (model_.events) {
    model_.events->append_scales(guard_scales_);
    happening_.assign(model_.events->monitors.size(), 0);
  }
}

void HybridSystem::handle_time_event(double t, double* z) {
  see(t, z);
  while (samples_at(t)) take_sample(t, z);
  act(t, z);
}

void HybridSystem::pass_stops(double now) {
  const std::vector<double>& stops = model_.stops;
  while (next_stop_ < stops.size() && stops[next_stop_] <= now) ++next_stop_;
  put_stop();
}

void HybridSystem::put_stop() {
  stop_ = next_stop_ < model_.stops.size() ? model_.stops[next_stop_] : unlimited;
}

void HybridSystem::see(double t, const double* z) {
  const double now = instant_end(t);
  if (stop_ <= now) pass_stops(now);
  if (!sampled_) return;
  while (sampled_->exchange.exposes_by(now)) sampled_->exchange.expose(z[0], z[1]);
}

std::optional<Pair> HybridSystem::begin_sample(double t) {
  return sampled_->exchange.begin_sample(instant_end(t));
}

const std::array<Jet<double>, 2>& HybridSystem::reference_at(double t) {
  KnownReference& known =
      shared_reference_ != nullptr ? shared_reference_->at(t) : known_reference_;
  if (known.t != t) {
    known = {t, with_loop([t](const auto& loop) { return loop.reference().at(t); })};
  }
  return known.value;
}

void HybridSystem::act(double t, double* z) {
  touched_ = !only_commands_change_ || t == 0;
  settled_ = false;
  leave_limits(std::nextafter(t, -unlimited), z);  // the input may jump at t
  if (sampled_) {
    const double now = instant_end(t);
    while (sampled_->exchange.commands_by(now)) apply_command();
  }
  if (touched_) settle(t, z);
}

ExternalController* HybridSystem::controller() const {
  return model_.rig && model_.rig->sampled ? model_.rig->sampled->external.get() : nullptr;
}

void HybridSystem::take_sample(double t, const double* z) {
  const double number = sampled_->exchange.sample_number();
  const std::optional<Pair> seen = begin_sample(t);
  const auto& reference = reference_at(t);
  SampledController& controller = sampled_->controller;
  double servo[4] = {z[servo_angle], z[servo_angle + 1], z[rate_], z[rate_ + 1]};
  if (ExternalController* const external = this->controller()) {
    if (number == 0) external->begin();
    const ControllerSample sample{static_cast<std::size_t>(number), t, seen, servo, reference};
    const Pair asked = external->command(sample, sampled_->own.data());
    end_sample(controller.within_limits(asked), seen.value_or(sampled_->measured));
    return;
  }
  const Between& between = model_.rig->between;
  if (!between.none()) between.believed(z + servo_angle, z + rate_, servo);
  const Pair command = controller.command(seen, servo, reference);
  end_sample(command, controller.last_seen());
}

void HybridSystem::apply_command() {
  const Pair command = sampled_->exchange.take_command();
  const std::array<double, 3> told = is_direct_ ? std::array<double, 3>{command[0], command[1], 0}
                                                : sampled_->controller.told(command);
  for (std::size_t i = 0; i < servos_.size(); ++i) {
    const double follows = servos_[i].follow(told[i]);
    if (follows == mode_->command[i]) continue;
    touched_ = true;
    mode_->command[i] = follows;
    if (dry_) dry_->command_jumps(i);
  }
  for (std::size_t i = 0; i < 2; ++i) mode_->wanted[i] = command[i];
}

HybridSystem::CommandRates HybridSystem::command_rates(double t, const double* z) const {
  rates_.resize(model_.size());
  std::visit([&](const auto& any) { any.derivative(t, z, rates_.data()); }, model_.system);
  return with_loop([&](const auto& loop) {
    using Loop = std::decay_t<decltype(loop)>;
    using Moving = simd::WithGradient<1>;
    const auto moving = [](double value, double rate) {
      return Moving(value, Moving::Gradient(rate));
    };
    Moving states[Loop::size];
    for (int k = 0; k < Loop::size; ++k)
      states[k] = moving(z[k], rates_[static_cast<std::size_t>(k)]);
    const auto axes = loop.axes(loop.inputs(moving(t, 1)), states);
    CommandRates rates;
    for (int i = 0; i < 2; ++i) {
      const auto axis = static_cast<std::size_t>(i);
      rates.raw[axis] = axes.command.raw[i].gradient[0];
      rates.shown[axis] = loop.shown(axes, i).gradient[0];
      if (loop.law().integrates(axis) && Loop::size > Loop::Layout::integral) {
        rates.raw[axis] -= rates_[static_cast<std::size_t>(Loop::Layout::integral) + axis];
      }
    }
    return rates;
  });
}

// The rate that the error adds to a command while its integral part does not wait, in its unit per
// second.
double HybridSystem::command_push(int i, double t, const double* z) const {
  return with_loop([&](const auto& loop) {
    return integral_rate(loop.law(), static_cast<std::size_t>(i), z, loop.inputs(t));
  });
}

OutwardRate HybridSystem::outward_rate(int i, double side, const CommandRates& rates, double t,
                                       const double* z) const {
  return {side * rates.raw[static_cast<std::size_t>(i)], side * command_push(i, t, z)};
}

// While a command moves along its limit, its integral part is not a state; the limit determines it.
// Restores the state at t, before another change.
void HybridSystem::leave_limits(double t, double* z) {
  if (dry_) dry_->leave_limits(model_, t, z);
  if (!switches_ || !model_.rig->limits_commands()) return;
  for (int i = 0; i < 2; ++i) {
    AxisMode& axis = mode_->axis[i];
    reached_[i] = axis.along != 0 ? axis.side : 0;
    if (reached_[i] == 0) continue;
    const double raw = axes(t, z).raw[static_cast<std::size_t>(i)];
    z[with_loop([](const auto& loop) { return std::decay_t<decltype(loop)>::Layout::integral; }) +
      i] += axis.set_command - raw;
  }
}

void HybridSystem::limit_command(int i, double side, AtLimit place, double push) {
  const CommandRange& limit = model_.rig->command_limit[i];
  AxisMode& axis = mode_->axis[i];
  const bool within = place == AtLimit::within;
  axis.command_factor = within ? 1 : 0;
  axis.side = within ? 0 : side;
  axis.set_command = within ? 0 : side > 0 ? limit.high : limit.low;
  axis.along = place == AtLimit::along ? 1 : 0;
  axis.integrate = within || (place == AtLimit::beyond && side * push < 0) ? 1 : 0;
}

// Determines whether each continuous command is at its limit, and whether its integral part waits.
void HybridSystem::settle_commands(double t, const double* z) {
  for (int i = 0; i < 2; ++i) {
    const CommandRange& limit = model_.rig->command_limit[i];
    const double raw = axes(t, z).raw[static_cast<std::size_t>(i)];
    const double side = raw > limit.high ? 1 : raw < limit.low ? -1 : 0;
    limit_command(i, side, side == 0 ? AtLimit::within : AtLimit::beyond, command_push(i, t, z));
  }
}

// Chooses how commands exactly at their limits continue, by their rates. The rates do not depend on
// the present mode, because all modes give the same command there.
void HybridSystem::settle_at_limits(double t, const double* z) {
  if (reached_[0] == 0 && reached_[1] == 0) return;
  const CommandRates rates = command_rates(t, z);
  for (int i = 0; i < 2; ++i) {
    if (reached_[i] == 0) continue;
    const OutwardRate outward = outward_rate(i, reached_[i], rates, t, z);
    limit_command(i, reached_[i], outward.at_limit(), reached_[i] * outward.push);
  }
}

MotorCommands HybridSystem::motor_commands(double t, const double* z, bool moving) const {
  if (!model_.rig || !dry_->integrates()) return {};
  return {axes(t, z).command, moving ? command_rates(t, z).shown : Pair{0, 0}};
}

AxisState HybridSystem::axis_state(int i, const Wanted& wanted, const double* z) const {
  return {z[servo_angle + i], z[rate_ + i], wanted.demand[i], wanted.told[i]};
}

LinkCurve& HybridSystem::curve(std::size_t axis) {
  return std::get<CoupledLoop<SignalPair, Linkages>>(model_.system).loop.link.of[axis];
}

// The system holds one piece of a measured curve at a time, so that the right-hand side is smooth.
void HybridSystem::put_pieces() {
  for (std::size_t i = 0; i < 2; ++i) {
    const Linkage& linkage = model_.rig->between.linkages[i];
    if (!linkage.table) continue;
    curve(i).piece = linkage.table->view().pieces[pieces_[i]];
    curve(i).command_piece = linkage.table->view().pieces[command_pieces_[i]];
  }
}

void HybridSystem::settle_pieces(double t, const double* z) {
  const Wanted wanted = axes(t, z);
  for (std::size_t i = 0; i < 2; ++i) {
    const Linkage& linkage = model_.rig->between.linkages[i];
    if (!linkage.table) continue;
    const AxisMode& axis = mode_->axis[i];
    const double horn = axis.ratio * z[static_cast<std::size_t>(servo_angle) + i] + axis.offset;
    pieces_[i] =
        linkage.piece_at(pieces_[i], horn, axis.ratio * z[static_cast<std::size_t>(rate_) + i]);
    if (!model_.rig->sampled && linkage.curve.assumed == Assumed::exact) {
      command_pieces_[i] = linkage.command_piece_at(command_pieces_[i], wanted.command[i]);
    }
  }
  put_pieces();
}

void HybridSystem::evaluate_pieces(const Wanted& wanted, const double* z, double* values) const {
  std::fill(values, values + 2 * piece_guards, unlimited);
  for (std::size_t i = 0; i < 2; ++i, values += piece_guards) {
    const Linkage& linkage = model_.rig->between.linkages[i];
    if (!linkage.table) continue;
    const AxisMode& axis = mode_->axis[i];
    const double horn = axis.ratio * z[static_cast<std::size_t>(servo_angle) + i] + axis.offset;
    const std::size_t last = linkage.table->knots().size() - 2;
    const CommandRange holds = linkage.piece_range(pieces_[i]);
    // The dead_point monitor handles the ends of the whole curve.
    if (pieces_[i] < last) values[0] = holds.high - horn;
    if (pieces_[i] > 0) values[1] = horn - holds.low;
    if (model_.rig->sampled || linkage.curve.assumed != Assumed::exact) continue;
    const CommandRange command = linkage.command_piece_range(command_pieces_[i]);
    const bool rises = linkage.curve.slope > 0;
    const bool at_first = command_pieces_[i] == 0, at_last = command_pieces_[i] == last;
    const double wants = wanted.command[i] + linkage.curve.shift;
    if (!(rises ? at_last : at_first)) values[2] = command.high - wants;
    if (!(rises ? at_first : at_last)) values[3] = wants - command.low;
  }
}

void HybridSystem::settle(double t, double* z) {
  if (model_.rig) settle_rig(t, z);
  if (dry_) {
    dry_->settle(model_, t, z, motor_commands(t, z, false).value);
    settle_at_limits(t, z);  // before the motors, which need the rates of the commands
    dry_->settle_at_limits(model_, t, z, motor_commands(t, z, true));
  } else {
    settle_at_limits(t, z);
  }
}

bool HybridSystem::stays_as_it_is(const double* z) const {
  if (!only_servos_settle_) return false;
  for (std::size_t i = 0; i < servos_.size(); ++i) {
    if (!servos_[i].stays_free(z[static_cast<std::size_t>(servo_angle) + i],
                               z[static_cast<std::size_t>(rate_) + i])) {
      return false;
    }
  }
  return true;
}

void HybridSystem::settle_rig(double t, double* z) {
  settled_ = !stays_as_it_is(z);
  if (!settled_) return;
  // The impulse of a stop may take the command to its limit, and this the servo from its stop. The
  // second round usually finds no change.
  constexpr int most_rounds = 8;
  for (int round = 0; round < most_rounds; ++round) {
    if (model_.rig->limits_commands()) settle_commands(t, z);
    const bool has_pieces = model_.rig->between.has_pieces();
    if (has_pieces) settle_pieces(t, z);
    if (!settle_servos(t, z)) return;
    reached_[0] = reached_[1] = 0;        // the rates have changed
    if (has_pieces) settle_pieces(t, z);  // with the new rates
  }
  unsettled_ = true;
}

// Returns whether a servo's state or a rate of the plane jumped.
bool HybridSystem::settle_servos(double t, double* z) {
  const Wanted wanted = axes(t, z);
  const RigExtras before = plane(z);
  const std::array<double, 5> ball_before{z[0], z[1], z[2], z[3], z[4]};
  bool moved = false;
  for (int i = 0; i < model_.rig->servos; ++i) {
    AxisState state = axis_state(i, wanted, z);
    servos_[static_cast<std::size_t>(i)].settle(state, mode_->axis[i]);
    moved = moved || state.angle != z[servo_angle + i] || state.rate != z[rate_ + i];
    z[servo_angle + i] = state.angle;
    z[rate_ + i] = state.rate;
  }
  const RigExtras now = plane(z);
  const double jump[2] = {now.rate[0] - before.rate[0], now.rate[1] - before.rate[1]};
  if (jump[0] == 0 && jump[1] == 0) return moved;
  const auto kick = with_loop([&](const auto& loop) { return loop.impulse(z, jump[0], jump[1]); });
  for (int i = 0; i < 3; ++i) z[2 + i] += kick[static_cast<std::size_t>(i)];
  // The servos apply any impulse that this takes. Its energy counts as their work.
  std::visit(
      [&](const auto& any) {
        using Any = std::decay_t<decltype(any)>;
        if constexpr (is_coupled_loop<Any>) {
          const CoupledBall& ball = any.parts.ball;
          z[Any::Layout::work] +=
              energy_of(ball, z, now) - energy_of(ball, ball_before.data(), before);
        }
      },
      model_.system);
  return true;
}

Sample HybridSystem::sample(double t, const double* z, Detail detail) const {
  return std::visit([&](const auto& system) { return system.sample(t, z, detail); }, model_.system);
}

void HybridSystem::evaluate_guards(double t, const double* z, double* values) const {
  if (switches_) {
    const Wanted wanted = axes(t, z);
    for (int i = 0; i < model_.rig->servos; ++i, values += axis_guards) {
      servos_[static_cast<std::size_t>(i)].evaluate(axis_state(i, wanted, z), values);
      double* const command = values + ServoAxis::guards;
      command[0] = command[1] = unlimited;
      if (i < 2) evaluate_limit(i, wanted.raw[static_cast<std::size_t>(i)], t, z, command);
    }
    if (model_.rig->between.has_pieces()) {
      evaluate_pieces(wanted, z, values);
      values += std::ptrdiff_t{2} * piece_guards;
    }
  }
  if (dry_) {
    dry_->evaluate(model_, t, z, motor_commands(t, z, dry_->moves_along_limit(model_)), values);
    values += DrySwitches::guards;
  }
  if (happening_.empty()) return;
  model_.events->margins(sample(t, z, Detail::motion), values);
  for (std::size_t m = 0; m < happening_.size(); ++m) {
    if (happening_[m] != 0) values[m] = -values[m];
  }
}

// Two guards of a continuous command: its limits; and at a limit, the behavior of its integral
// part.
void HybridSystem::evaluate_limit(int i, double raw, double t, const double* z,
                                  double* values) const {
  const CommandRange& limit = model_.rig->command_limit[i];
  if (!limit.binds()) return;
  const AxisMode& axis = mode_->axis[i];
  if (axis.side == 0) {
    values[0] = limit.high - raw;
    values[1] = raw - limit.low;
  } else if (axis.along != 0) {
    const OutwardRate outward = outward_rate(i, axis.side, command_rates(t, z), t, z);
    values[0] = outward.within();
    values[1] = -outward.beyond();
  } else {
    // Only the present limit needs a guard: the command can reach the other only through the range
    // between.
    const int own = axis.side > 0 ? 0 : 1;
    values[own] = axis.side * (raw - axis.set_command);
    const double push = axis.side * command_push(i, t, z);
    if (integrates(i)) values[1 - own] = axis.integrate != 0 ? -push : push;
  }
}

// Records the limit that a command reached, if guard `fallen` says so.
void HybridSystem::note_limit(std::size_t fallen) {
  const std::size_t first_dry = first_monitor() - DrySwitches::guards;
  if (dry_ && fallen >= first_dry) dry_->note_limit(model_, fallen - first_dry);
  const std::size_t i = fallen / axis_guards, guard = fallen % axis_guards;
  if (!switches_ || i >= std::min<std::size_t>(servos_.size(), 2) || guard < ServoAxis::guards ||
      !integrates(static_cast<int>(i))) {
    return;
  }
  const bool upper = guard == ServoAxis::guards;
  const double side = upper ? 1 : -1, present = mode_->axis[i].side;
  if (present == 0 || (present == side && mode_->axis[i].along == 0)) reached_[i] = side;
}

bool HybridSystem::integrates(int i) const {
  return with_loop(
      [i](const auto& loop) { return loop.law().integrates(static_cast<std::size_t>(i)); });
}

std::array<HeldMotion, 2> HybridSystem::held_motions(const double* z) const {
  return with_loop([&](const auto& loop) {
    std::array<HeldMotion, 2> motions;
    for (std::size_t i = 0; i < 2; ++i) {
      motions[i] = held_motion(loop.servo().of[i], loop.mode.axis[i], loop.mode.command[i],
                               z[servo_angle + i], z[rate_ + i]);
    }
    return motions;
  });
}

HybridSystem::Fall HybridSystem::next_fall(double t, const std::array<HeldMotion, 2>& motions,
                                           double end) {
  Fall first;
  if (!switches_) return first;
  for (std::size_t i = 0; i < 2; ++i) {
    const ServoAxis::Fall fall = servos_[i].first_fall(motions[i], mode_->command[i], t,
                                                       std::min(end, first.time) - t, answers_);
    // Rounds up, so that the guard has fallen at that time even if the step is below the rounding
    // of t.
    double at = t + fall.after;
    if (at - t < fall.after) at = std::nextafter(at, unlimited);
    if (at < first.time) first = {at, i * axis_guards + static_cast<std::size_t>(fall.guard)};
  }
  return first;
}

HybridSystem::Effect HybridSystem::occur(std::size_t monitor, double t, const double* z) {
  happening_[monitor] = 1;
  const Monitor& what = model_.events->monitors[monitor];
  return occur(what.name(), what.action == OnEvent::stop, t, z);
}

HybridSystem::Effect HybridSystem::occur(std::string name, bool stops, double t, const double* z) {
  Sample now = sample(t, z, Detail::all);
  now.gamma = model_.gamma_not_integrated();
  if (sampled_) now.measured = sampled_->measured;
  occurrences_.push_back(
      {t, std::move(name), stops, now, sampled_ ? sampled_->own : std::vector<double>{}});
  return stops ? Effect::stop : Effect::none;
}

void HybridSystem::note_turned(double integral) {
  for (; with_gamma_ < occurrences_.size(); ++with_gamma_) {
    if (model_.gamma) occurrences_[with_gamma_].sample.gamma = integral / model_.radius;
  }
}

HybridSystem::Effect HybridSystem::handle_state_event(std::size_t i, double t, double* z) {
  const std::size_t first_monitor = guards() - happening_.size();
  if (i < first_monitor) {
    leave_limits(t, z);
    note_limit(i);
    settle(t, z);
    return note_dry(t, z) == Effect::stop ? Effect::stop : Effect::restart;
  }
  const std::size_t monitor = i - first_monitor;
  if (happening_[monitor] == 0) return occur(monitor, t, z);
  happening_[monitor] = 0;
  return Effect::none;
}

// Notes the starts and ends of sliding since the last call, and those rests that are events of the
// scene.
HybridSystem::Effect HybridSystem::note_dry(double t, const double* z) {
  if (!dry_) return Effect::none;
  const DrySwitches::State now = dry_->state(model_), before = std::exchange(dry_state_, now);
  Effect effect = Effect::none;
  const auto note = [&](const char* name, const std::optional<OnEvent>& event) {
    if (event && occur(name, *event == OnEvent::stop, t, z) == Effect::stop) effect = Effect::stop;
  };
  if (now.slides != before.slides) note(now.slides ? "slip" : "roll", OnEvent::note);
  if (now.rests && !before.rests) note("rest", model_.dry->rest);
  if (now.sticks[0] && !before.sticks[0]) note("stick_phi", model_.dry->stick);
  if (now.sticks[1] && !before.sticks[1]) note("stick_theta", model_.dry->stick);
  return effect;
}

bool HybridSystem::stops(std::size_t i) const {
  const std::size_t first_monitor = guards() - happening_.size();
  return i >= first_monitor && happening_[i - first_monitor] == 0 &&
         model_.events->monitors[i - first_monitor].action == OnEvent::stop;
}

HybridSystem::Effect HybridSystem::check_events(double t, const double* z) {
  if (note_dry(t, z) == Effect::stop) return Effect::stop;
  if (happening_.empty()) return Effect::none;
  std::vector<double> margins(happening_.size());
  model_.events->margins(sample(t, z, Detail::motion), margins.data());
  for (std::size_t m = 0; m < happening_.size(); ++m) {
    const bool beyond = margins[m] < 0;
    if (beyond && happening_[m] == 0 && occur(m, t, z) == Effect::stop) return Effect::stop;
    if (!beyond) happening_[m] = 0;
  }
  return Effect::none;
}

template <class Archive>
void HybridSystem::archive(Archive& archive) {
  if (model_.rig) {
    archive(*mode_);
    archive.require(is_finite(*mode_));
  }
  archive(next_stop_);
  archive.require(next_stop_ <= model_.stops.size());
  put_stop();
  archive.fixed(happening_);
  for (const char one : happening_) archive.require(one == 0 || one == 1);
  for (ServoAxis& servo : servos_) archive(servo);
  if (model_.rig && model_.rig->between.has_pieces()) {
    archive(pieces_, command_pieces_);
    for (std::size_t i = 0; i < 2; ++i) {
      const Linkage& linkage = model_.rig->between.linkages[i];
      const std::size_t pieces = linkage.table ? linkage.table->knots().size() - 1 : 1;
      archive.require(pieces_[i] < pieces && command_pieces_[i] < pieces);
    }
    put_pieces();
  }
  if (!sampled_) return;
  Sampled& of = *sampled_;
  archive(of.exchange, of.controller, of.measured);
  archive.require(is_finite(of.measured));
  archive.fixed(of.own);
}

template void HybridSystem::archive(StateWriter&);
template void HybridSystem::archive(StateReader&);

void HybridSystem::write_extras(double t, const double* z, double* out) const {
  const Pair measured = sampled_ ? sampled_->measured : Pair{z[0], z[1]};
  std::visit(
      [&](const auto& system) {
        using Any = std::decay_t<decltype(system)>;
        if constexpr (is_rig<Any>) {
          RigExtras extras = system.extras(t, z);
          std::copy(measured.begin(), measured.end(), extras.measured);
          extras.pack(out);
        } else if constexpr (is_coupled<Any>) {
          CoupledExtras extras = system.extras(t, z);
          if constexpr (is_coupled_loop<Any>) {
            std::copy(measured.begin(), measured.end(), extras.rig.measured);
          }
          extras.pack(out);
        }
      },
      model_.system);
  if (sampled_ && !sampled_->own.empty()) {
    std::copy(sampled_->own.begin(), sampled_->own.end(),
              out + model_.extras() - sampled_->own.size());
  }
}

}  // namespace bbsim::model
