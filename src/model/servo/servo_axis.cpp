#include "model/servo/servo_axis.hpp"

#include <algorithm>
#include <cmath>

namespace bbsim::model {
namespace {

// A guard that was found at zero is this near it.
constexpr double at_limit = 1 - 1e-11;

}  // namespace

double ServoAxis::follow(double command) {
  if (std::abs(command - target_) > rig_->dead_band) target_ = command;
  return target_;
}

double ServoAxis::push(const AxisState& state) const {
  if (!rig_->time_constant) return state.demand;
  return (state.command - state.angle) / *rig_->time_constant - state.rate;
}

ServoAxis::Motion ServoAxis::choose(AxisState& state) const {
  const double stop = rig_->angle_limit, fastest = rig_->rate_limit;
  if (rig_->time_constant) {
    state.rate =
        std::clamp((state.command - state.angle) / *rig_->time_constant, -fastest, fastest);
  }
  for (const int sign : {1, -1}) {
    if (sign * state.angle < stop * at_limit || sign * state.rate < 0) continue;
    AxisState halted = state;
    halted.rate = 0;
    halted.demand += response_.from_rate * state.rate;
    const double pushing = rig_->time_constant ? halted.command - halted.angle : halted.demand;
    if (sign * pushing < 0 && state.rate == 0) continue;
    halted.angle = sign * stop;
    state = halted;
    if (sign * pushing >= 0) return sign > 0 ? Motion::stop_up : Motion::stop_down;
  }
  for (const int sign : {1, -1}) {
    if (sign * state.rate >= fastest * at_limit && sign * push(state) > 0) {
      state.rate = sign * fastest;
      return sign > 0 ? Motion::rate_up : Motion::rate_down;
    }
  }
  if (!rig_->time_constant) {
    if (state.demand > rig_->acceleration_limit) return Motion::accelerating_up;
    if (state.demand < -rig_->acceleration_limit) return Motion::accelerating_down;
  }
  return Motion::free;
}

void ServoAxis::settle_backlash(const AxisState& state, AxisMode& mode) {
  const double half = rig_->backlash / 2;
  if (half <= 0) {
    mode.ratio = 1;
    mode.offset = offset_;
    return;
  }
  if (!started_) plane_ = state.angle + offset_;
  // While engaged the plane went with the servo.
  if (started_ && play_ == Play::up) plane_ = state.angle - half + offset_;
  if (started_ && play_ == Play::down) plane_ = state.angle + half + offset_;
  started_ = true;
  const double lead = state.angle + offset_ - plane_;
  const double touching = half * at_limit;
  if (lead >= touching && state.rate > 0) {
    play_ = Play::up;
  } else if (lead <= -touching && state.rate < 0) {
    play_ = Play::down;
  } else {
    play_ = Play::gap;
  }
  mode.ratio = play_ == Play::gap ? 0 : 1;
  mode.offset = play_ == Play::gap ? plane_ : offset_ + (play_ == Play::up ? -half : half);
}

void ServoAxis::settle(AxisState& state, AxisMode& mode) {
  motion_ = choose(state);
  mode.demand_factor = 0;
  mode.set_acceleration = 0;
  switch (motion_) {
    case Motion::free:
      mode.demand_factor = 1;
      break;
    case Motion::accelerating_up:
      mode.set_acceleration = rig_->acceleration_limit;
      break;
    case Motion::accelerating_down:
      mode.set_acceleration = -rig_->acceleration_limit;
      break;
    default:
      break;
  }
  settle_backlash(state, mode);
}

void ServoAxis::evaluate(const AxisState& state, double* values) const {
  std::fill(values, values + guards, unlimited);
  const double a = state.demand, most = rig_->acceleration_limit;
  const double stop = rig_->angle_limit, fastest = rig_->rate_limit;
  switch (motion_) {
    case Motion::free:
      values[0] = rig_->time_constant ? unlimited : most - a;
      values[1] = rig_->time_constant ? unlimited : most + a;
      break;
    case Motion::accelerating_up:
      values[0] = a - most;
      break;
    case Motion::accelerating_down:
      values[1] = -a - most;
      break;
    case Motion::rate_up:
      values[2] = push(state);
      break;
    case Motion::rate_down:
      values[3] = -push(state);
      break;
    case Motion::stop_up:
      values[4] = rig_->time_constant ? state.command - state.angle : a;
      break;
    case Motion::stop_down:
      values[5] = rig_->time_constant ? state.angle - state.command : -a;
      break;
  }
  const bool limited = motion_ == Motion::rate_up || motion_ == Motion::rate_down;
  const bool halted = motion_ == Motion::stop_up || motion_ == Motion::stop_down;
  if (!limited && !halted) {
    values[2] = fastest - state.rate;
    values[3] = fastest + state.rate;
  }
  if (!halted) {
    values[4] = stop - state.angle;
    values[5] = stop + state.angle;
  }
  const double half = rig_->backlash / 2;
  switch (play_) {
    case Play::none:
      break;
    case Play::up:
      values[6] = state.rate;
      break;
    case Play::down:
      values[6] = -state.rate;
      break;
    case Play::gap:
      values[6] = half - (state.angle + offset_ - plane_);
      values[7] = half + (state.angle + offset_ - plane_);
      break;
  }
}

void ServoAxis::scales(double* values) const {
  const auto finite = [](double value) { return value < unlimited ? value : 1.0; };
  const double acceleration = finite(rig_->acceleration_limit);
  values[0] = values[1] = acceleration;
  values[2] = values[3] = finite(rig_->rate_limit);
  values[4] = values[5] = finite(rig_->angle_limit);
  values[6] = values[7] = rig_->backlash > 0 ? rig_->backlash : 1.0;
}

}  // namespace bbsim::model
