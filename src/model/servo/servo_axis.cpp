// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/servo/servo_axis.hpp"

namespace bbsim::model {

AxisMargin ServoAxis::push() const {
  AxisMargin push{0};
  if (!servo_.time_constant) {
    push.by_demand = 1;
    return push;
  }
  push.by_command = 1 / *servo_.time_constant;
  push.by_angle = -push.by_command;
  push.by_rate = -1;
  return push;
}

AxisMargin ServoAxis::push_at_stop() const {
  AxisMargin push{0};
  if (servo_.time_constant) {
    push.by_command = 1;
    push.by_angle = -1;
  } else {
    push.by_demand = 1;
  }
  return push;
}

ServoAxis::Motion ServoAxis::choose(AxisState& state) {
  const double stop = servo_.angle_limit, fastest = servo_.rate_limit;
  if (servo_.time_constant) {
    state.rate =
        std::clamp((state.command - state.angle) / *servo_.time_constant, -fastest, fastest);
  }
  for (const int sign : {1, -1}) {
    if (sign * state.angle < stop * at_limit || sign * state.rate < 0) continue;
    AxisState halted = state;
    halted.rate = 0;
    halted.demand += response_.from_rate * state.rate;
    const double pushing = push_at_stop().at(halted);
    if (sign * pushing < 0 && state.rate == 0) continue;
    halted.angle = sign * stop;
    state = halted;
    if (sign * pushing < 0) continue;
    limit_side_ = sign;
    return Motion::at_stop;
  }
  for (const int sign : {1, -1}) {
    if (sign * state.rate >= fastest * at_limit && sign * push().at(state) > 0) {
      state.rate = sign * fastest;
      limit_side_ = sign;
      return Motion::at_rate;
    }
  }
  if (servo_.time_constant || !(std::abs(state.demand) > servo_.acceleration_limit)) {
    return Motion::free;
  }
  limit_side_ = state.demand > 0 ? 1 : -1;
  return Motion::accelerating;
}

void ServoAxis::settle_backlash(const AxisState& state, AxisMode& mode) {
  const double half = servo_.backlash / 2;
  if (half <= 0) {
    mode.ratio = 1;
    mode.offset = servo_.offset;
    return;
  }
  if (!started_) plane_ = state.angle + servo_.offset;
  // While engaged, the plane moved with the servo.
  if (started_ && play_ == Play::contact) {
    plane_ = state.angle - contact_side_ * half + servo_.offset;
  }
  started_ = true;
  const double lead = state.angle + servo_.offset - plane_;
  const double rounding = guard_rounding * gap_scale(state.angle);
  const double touching = half - std::max((1 - at_limit) * half, rounding);
  // A servo at rest moves in the direction of its drive. Engaging it against that would last no
  // time.
  const double at_rest = rounding;
  play_ = Play::gap;
  mode.ratio = 0;
  mode.offset = plane_;
  for (const int sign : {1, -1}) {
    const bool moves =
        sign * state.rate > at_rest || (sign * state.rate >= -at_rest && sign * drive(state) > 0);
    if (!(sign * lead >= touching && moves)) continue;
    play_ = Play::contact;
    contact_side_ = sign;
    mode.ratio = 1;
    mode.offset = servo_.offset - sign * half;
    break;
  }
}

// The servo's acceleration. Zero for first order, where the command sets the rate directly.
double ServoAxis::drive(const AxisState& state) const {
  if (servo_.time_constant) return 0;
  switch (motion_) {
    case Motion::free:
      return state.demand;
    case Motion::on_ramp:
      return ramp_.acceleration;
    case Motion::accelerating:
      return limit_side_ * servo_.acceleration_limit;
    default:
      return 0;
  }
}

void ServoAxis::plan_ramp(AxisState& state) {
  const bool is_new = std::exchange(has_new_target_, false);
  may_stall_ = may_stall_ || is_new;
  if (follows_pulses()) {
    if (is_new) state.rate = (target_ - state.angle) / servo_.pulse_time;
    ramp_ = part_at_rate(state.angle, state.rate, target_);
  } else {
    ramp_ = next_part(state.angle, state.rate, target_, servo_);
  }
}

double ServoAxis::stall_rate() const {
  const double pull = std::abs(ramp_.acceleration);
  if (pull > servo_.torque_limit) return 0;
  return pull > 0 ? servo_.corner_rate * servo_.torque_limit / pull : unlimited;
}

// A rotor stalls if its field asks for more than its torque: a field that runs past pulls it
// forward and back in turns. The field passes it once a period. The last time before the field
// halts, the rotor follows again. In a move shorter than a period it catches up.
void ServoAxis::settle_stall(const AxisState& state, AxisMode& mode) {
  const double period = servo_.field_period;
  if (stalls_ && catches_ != 0 && std::abs(state.angle - caught_at_) <= 2 * same_angle) {
    lost_ += caught_at_ - stalled_at_;
    stalls_ = false;
  }
  if (!stalls_ && may_stall_ && std::abs(state.rate) >= stall_rate() * at_limit) {
    loses_ = true;
    may_stall_ = false;  // until the next target
    stalls_ = std::abs(target_ - state.angle) >= period;
    stalled_at_ = state.angle;
  }
  if (stalls_) {
    const double way = (target_ - stalled_at_) / period,
                 done = (state.angle - stalled_at_) / period;
    const double forward = target_ > state.angle ? 1 : -1;
    const double last = forward * std::floor(forward * way);
    catches_ = forward * (last - done) > 0 ? forward : 0;
    caught_at_ = stalled_at_ + last * period;
  }
  field_ = {stalls_ ? 0.0 : 1.0, stalls_ ? stalled_at_ - lost_ : -lost_};
  if (servo_.rings) return;
  mode.ratio = field_.ratio;
  mode.offset += field_.offset;
}

void ServoAxis::settle(AxisState& state, AxisMode& mode) {
  if (servo_.step > 0) {
    motion_ = Motion::on_ramp;
    plan_ramp(state);
  } else {
    motion_ = choose(state);
  }
  const bool is_free = motion_ == Motion::free;
  mode.demand_factor = is_free ? 1 : 0;
  mode.set_acceleration = is_free ? 0 : drive(state);
  settle_backlash(state, mode);
  if (servo_.torque_limit < unlimited) settle_stall(state, mode);
  const bool calm = is_free && play_ == Play::none && !servo_.time_constant;
  calm_angle_ = calm ? servo_.angle_limit * at_limit : 0;
  calm_rate_ = calm ? servo_.rate_limit * at_limit : 0;
}

template <class Use>
void ServoAxis::for_each_margin(Use use) const {
  // Guards both directions: keeps the component `by` below `most`.
  const auto below = [&](int guard, double most, double AxisMargin::*by, double offset = 0) {
    if (most == unlimited) return;
    for (const int sign : {1, -1}) {
      AxisMargin margin{most - sign * offset};
      margin.*by = -sign;
      use(sign > 0 ? guard : guard + 1, margin);
    }
  };
  const int side = limit_side_;
  // Keeps a drive outward at a limit; `guard` watches the upper limit, and the next the lower one.
  const auto outward = [&](int guard, const AxisMargin& drive) {
    use(side > 0 ? guard : guard + 1,
        AxisMargin{side * drive.constant, side * drive.by_angle, side * drive.by_rate,
                   side * drive.by_demand, side * drive.by_command});
  };
  const double most = servo_.acceleration_limit;
  switch (motion_) {
    case Motion::on_ramp: {
      if (stalls_ && catches_ != 0) {
        use(stop_down, AxisMargin{catches_ * caught_at_, -catches_});
      }
      const double stall = may_stall_ && !stalls_ ? stall_rate() : unlimited;
      if (stall < unlimited) {
        const double forward = ramp_.acceleration > 0 ? 1 : -1;
        use(rate_down, AxisMargin{stall, 0, -forward});
      }
      if (ramp_.until == RampPart::Until::ever) break;
      const double sign = ramp_.rising ? 1 : -1;
      AxisMargin margin{sign * ramp_.level};
      const bool by_angle = ramp_.until == RampPart::Until::angle;
      (by_angle ? margin.by_angle : margin.by_rate) = -sign;
      use(by_angle ? stop_up : rate_up, margin);
      break;
    }
    case Motion::free:
      if (!servo_.time_constant) below(acceleration_up, most, &AxisMargin::by_demand);
      break;
    case Motion::accelerating:
      outward(acceleration_up, {-side * most, 0, 0, 1, 0});
      break;
    case Motion::at_rate:
      outward(rate_up, push());
      break;
    case Motion::at_stop:
      outward(stop_up, push_at_stop());
      break;
  }
  const bool halted = motion_ == Motion::at_stop || motion_ == Motion::on_ramp;
  if (motion_ != Motion::at_rate && !halted) {
    below(rate_up, servo_.rate_limit, &AxisMargin::by_rate);
  }
  if (!halted) below(stop_up, servo_.angle_limit, &AxisMargin::by_angle);
  switch (play_) {
    case Play::none:
      break;
    case Play::contact:
      use(gap_up, AxisMargin{0, 0, static_cast<double>(contact_side_)});
      break;
    case Play::gap:
      below(gap_up, servo_.backlash / 2, &AxisMargin::by_angle, servo_.offset - plane_);
      break;
  }
}

void ServoAxis::evaluate(const AxisState& state, double* values) const {
  std::fill(values, values + guards, unlimited);
  for_each_margin([&](int guard, const AxisMargin& margin) { values[guard] = margin.at(state); });
}

ServoAxis::Clearance ServoAxis::clearance() const {
  constexpr double clearly = 1 - 1e-12;
  if (!servo_.switches()) return {unlimited, unlimited, unlimited, root_};
  if (motion_ != Motion::free || play_ != Play::none || !(root_ > 0)) return {0, 0, 0, root_};
  return {clearly * servo_.angle_limit, clearly * servo_.rate_limit,
          clearly * servo_.acceleration_limit, root_};
}

ServoAxis::Crossing ServoAxis::first_crossing(const HeldMotion& motion, double command,
                                              double start, double end,
                                              KnownAnswers& answers) const {
  Crossing first;
  const bool springs = root_ > 0 && motion.law.stiffness == response_.from_angle;
  const MotionReach reached = springs ? reach_about(motion, root_) : reach(motion, end);
  if (springs && clearance().holds(reached, motion.law)) return first;
  for_each_margin([&](int guard, const AxisMargin& margin) {
    const MotionLine line{
        margin.constant + (margin.by_command + margin.by_demand * response_.from_command) * command,
        margin.by_angle - margin.by_demand * response_.from_angle,
        margin.by_rate - margin.by_demand * response_.from_rate};
    if (reached.least(line) > guard_rounding * std::abs(line.constant)) return;  // the common case
    double sizes[guards];
    scales(sizes);
    // The same thresholds as for the integrators' guards.
    const double after = model::first_crossing(line, motion, guard_rounding * sizes[guard], start,
                                               std::min(end, first.after), answers);
    if (after < first.after) first = {after, guard};
  });
  return first;
}

void ServoAxis::scales(double* values) const {
  const auto finite = [](double value) { return value < unlimited ? value : 1.0; };
  const double acceleration = finite(servo_.acceleration_limit);
  values[acceleration_up] = values[acceleration_down] = acceleration;
  values[rate_up] = values[rate_down] = finite(servo_.rate_limit);
  values[stop_up] = values[stop_down] = finite(servo_.angle_limit);
  values[gap_up] = values[gap_down] = gap_scale(0);
}

}  // namespace bbsim::model
