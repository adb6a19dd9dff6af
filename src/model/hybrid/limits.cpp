// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/hybrid/limits.hpp"

#include <utility>

namespace bbsim::model {

void CommandLimits::append_scales(std::vector<double>& scales) const {
  for (std::size_t i = 0; i < 2; ++i) {
    for (const double of : {limit(i).high, limit(i).low}) {
      scales.push_back(std::abs(of) < unlimited && of != 0 ? std::abs(of) : 1.0);
    }
  }
}

// Rate at which the integral part adds to a command while it does not wait, in the command's unit
// per second.
double CommandLimits::push(std::size_t i, double t, const double* z) const {
  return model_.with_loop(
      [&](const auto& loop) { return integral_rate(loop.law(), i, z, loop.inputs(t)); });
}

void CommandLimits::evaluate(const GuardContext& now, double* values) const {
  std::fill(values, values + guards(), unlimited);
  for (std::size_t i = 0; i < 2; ++i, values += Guard::count) {
    if (!limit(i).binds()) continue;
    const AxisMode& axis = model_.mode().axis[i];
    const double raw = now.demands().raw[i];
    if (axis.side == 0) {
      values[Guard::high] = limit(i).high - raw;
      values[Guard::low] = raw - limit(i).low;
    } else if (axis.along != 0) {
      const OutwardRate outward = outward_rate(i, axis.side, now);
      values[0] = outward.within();
      values[1] = -outward.beyond();
    } else {
      // Only this limit needs a guard: to reach the other, the command must first return to
      // the range between.
      const std::size_t own = axis.side > 0 ? Guard::high : Guard::low;
      values[own] = axis.side * (raw - axis.set_command);
      const double drives = axis.side * push(i, now.t, now.z);
      if (integrates(i)) values[1 - own] = axis.integrate != 0 ? -drives : drives;
    }
  }
}

void CommandLimits::cross(std::size_t guard) {
  const std::size_t i = guard / Guard::count;
  if (!integrates(i)) return;
  const double side = guard % Guard::count == Guard::high ? 1 : -1;
  const AxisMode& axis = model_.mode().axis[i];
  if (axis.side == 0 || (axis.side == side && axis.along == 0)) reached_[i] = side;
}

void CommandLimits::leave_mode(double t, double* z) {
  for (std::size_t i = 0; i < 2; ++i) {
    const AxisMode& axis = model_.mode().axis[i];
    reached_[i] = axis.along != 0 ? axis.side : 0;
    if (reached_[i] == 0) continue;
    const double raw = model_.demands(t, z).raw[i];
    const std::size_t integral = model_.with_loop([](const auto& loop) {
      return static_cast<std::size_t>(std::decay_t<decltype(loop)>::Layout::integral);
    });
    z[integral + i] += axis.set_command - raw;
  }
}

void CommandLimits::put(std::size_t i, double side, AtLimit place, double push) {
  AxisMode& axis = model_.mode().axis[i];
  const bool within = place == AtLimit::within;
  axis.command_factor = within ? 1 : 0;
  axis.side = within ? 0 : side;
  axis.set_command = within ? 0 : side > 0 ? limit(i).high : limit(i).low;
  axis.along = place == AtLimit::along ? 1 : 0;
  axis.integrate = within || (place == AtLimit::beyond && side * push < 0) ? 1 : 0;
}

bool CommandLimits::reset(double t, double* z) {
  for (std::size_t i = 0; i < 2; ++i) {
    const double raw = model_.demands(t, z).raw[i];
    const double side = raw > limit(i).high ? 1 : raw < limit(i).low ? -1 : 0;
    put(i, side, side == 0 ? AtLimit::within : AtLimit::beyond, push(i, t, z));
  }
  return false;
}

// The present mode does not affect the rates: at a limit, all modes give the same command.
void CommandLimits::reset_at_limits(double t, const double* z) {
  const GuardContext now(model_, t, z);
  for (std::size_t i = 0; i < 2; ++i) {
    if (reached_[i] == 0) continue;
    const OutwardRate outward = outward_rate(i, reached_[i], now);
    put(i, reached_[i], outward.at_limit(), reached_[i] * outward.push);
  }
}

// Rate at which the integral adds to the torque asked of motor i while it does not wait, N m/s.
double MotorLimits::push(std::size_t i, const GuardContext& now) const {
  const double command = parts_.integrates ? now.demands().command[i] : 0;
  return scene_.law.from_integral * (command - now.z[scene_.angle + i]);
}

OutwardRate MotorLimits::outward_rate(std::size_t i, double side, const GuardContext& now) const {
  const double rate = now.z[scene_.rate + i], acceleration = now.balance().acceleration[i];
  const double asked = scene_.law.from_command * now.command_rates().shown[i] -
                       scene_.law.from_angle * rate - scene_.law.from_rate * acceleration;
  const bool by_voltage = range(i, now.z).is_by_voltage(side);
  const double limit = by_voltage ? -parts_.torque_by_rate * acceleration : 0.0;
  return {side * (asked - limit), side * push(i, now)};
}

void MotorLimits::evaluate(const GuardContext& now, double* values) const {
  std::fill(values, values + guards(), unlimited);
  for (std::size_t i = 0; i < 2; ++i, values += Guard::count) {
    if (scene_.motors[i].along != 0) {
      evaluate_along(i, now, values);
    } else {
      evaluate_not_along(i, now, values);
    }
    for (std::size_t k = 0; k < Guard::count; ++k) {
      if (std::isnan(values[k])) values[k] = unlimited;
    }
  }
}

void MotorLimits::evaluate_along(std::size_t i, const GuardContext& now, double* values) const {
  const MotorMode& motor = scene_.motors[i];
  const TorqueRange range = this->range(i, now.z);
  const bool at_voltage = motor.by_rate != 0, at_torque = motor.factor == 0 && !at_voltage;
  const bool overrun = at_torque && motor.set * motor.side < 0;
  const OutwardRate outward = outward_rate(i, motor.side, now);
  values[0] = overrun ? outward.beyond_other() : outward.within();
  values[1] = -outward.beyond();
  // The other kind of limit takes over, or both limits coincide.
  const double given = std::abs(range.by_voltage(motor.side));
  values[2] = at_voltage ? range.torque - given : given - range.torque;
  if (at_torque && !overrun) {
    values[3] = range.torque + (motor.set < 0 ? range.up : -range.down);
  }
}

// Compares the torque asked with the voltage's limits, and the clamped torque with the torque
// limit.
void MotorLimits::evaluate_not_along(std::size_t i, const GuardContext& now, double* values) const {
  const MotorMode& motor = scene_.motors[i];
  const auto [up, down, torque] = range(i, now.z);
  const double asked = now.balance().asked[i];
  const bool at_voltage = motor.by_rate != 0, at_torque = motor.factor == 0 && !at_voltage;
  std::size_t spare = Guard::voltage_up;
  if (at_torque) {
    // The torque asked returns to the limit, or the voltage's limit takes over.
    values[Guard::torque_up] = motor.side * (asked - motor.set);
    values[Guard::voltage_down] =
        std::copysign(1.0, motor.set) * (motor.side > 0 ? up : down) - torque;
  } else {
    const double left = std::clamp(asked, down, up);
    values[Guard::torque_up] = torque - left;
    values[Guard::torque_down] = torque + left;
    values[Guard::voltage_up] = at_voltage && motor.set > 0 ? asked - up : up - asked;
    values[Guard::voltage_down] = at_voltage && motor.set < 0 ? down - asked : asked - down;
    spare = motor.set > 0 ? Guard::voltage_down : Guard::voltage_up;
    if (at_voltage) values[spare] = unlimited;
  }
  if (motor.side != 0 && parts_.integrates) {
    const double drives = motor.side * push(i, now);
    values[spare] = motor.integrate != 0 ? -drives : drives;
  }
}

void MotorLimits::cross(std::size_t guard) {
  if (!parts_.integrates) return;
  const std::size_t i = guard / Guard::count, which = guard % Guard::count;
  const MotorMode& motor = scene_.motors[i];
  if (motor.along != 0) return;  // leave_mode() has recorded it
  if (motor.side == 0) {
    reached_[i] = which == Guard::voltage_up || which == Guard::torque_up ? 1 : -1;
    return;
  }
  // The torque asked of the motor returns to the limit.
  const std::size_t own = motor.by_rate == 0 ? Guard::torque_up
                          : motor.side > 0   ? Guard::voltage_up
                                             : Guard::voltage_down;
  if (which == own) reached_[i] = motor.side;
}

void MotorLimits::leave_mode(double t, double* z) {
  if (!parts_.integrates) return;
  for (std::size_t i = 0; i < 2; ++i) {
    const MotorMode& motor = scene_.motors[i];
    reached_[i] = motor.along != 0 ? motor.side : 0;
    if (reached_[i] == 0) continue;
    const double beyond = model_.balance(t, z).asked[i] - range(i, z).at(motor.side);
    z[scene_.integral + i] -= beyond / scene_.law.from_integral;
  }
}

bool MotorLimits::reset(double t, double* z) {
  const GuardContext now(model_, t, z);
  for (std::size_t i = 0; i < 2; ++i) {
    const double asked = now.balance().asked[i];
    const auto [up, down, torque] = range(i, z);
    MotorMode& motor = scene_.motors[i];
    const double by_voltage = std::clamp(asked, down, up);
    motor.by_rate = motor.set = motor.factor = motor.along = 0;
    if (std::abs(by_voltage) > torque) {
      motor.set = std::copysign(torque, by_voltage);
    } else if (by_voltage != asked) {
      motor.set = std::copysign(parts_.stall_torque, asked - by_voltage);
      motor.by_rate = -parts_.torque_by_rate;
    } else {
      motor.factor = 1;
    }
    const double given = std::clamp(by_voltage, -torque, torque);
    motor.side = motor.factor != 0 ? 0 : asked > given ? 1 : -1;
    motor.integrate = motor.factor != 0 || motor.side * push(i, now) < 0 ? 1 : 0;
  }
  return false;
}

void MotorLimits::reset_at_limits(double t, const double* z) {
  if (!parts_.integrates) return;
  const GuardContext now(model_, t, z);
  for (std::size_t i = 0; i < 2; ++i) {
    double side = std::exchange(reached_[i], 0);
    if (side == 0) continue;
    const TorqueRange range = this->range(i, z);
    const bool overrun = range.overruns();
    if (overrun) side = range.up < 0 ? 1 : -1;
    MotorMode& motor = scene_.motors[i];
    const OutwardRate outward = outward_rate(i, side, now);
    const AtLimit place = outward.at_limit(overrun ? outward.beyond_other() : outward.within());
    const bool by_voltage = range.is_by_voltage(side);
    const bool within = place == AtLimit::within && !overrun;
    // Beyond the other limit, which has the same value.
    const bool at_other = place == AtLimit::within && overrun;
    motor.factor = within ? 1 : 0;
    motor.side = within ? 0 : at_other ? -side : side;
    motor.by_rate = !within && by_voltage ? -parts_.torque_by_rate : 0;
    motor.set = within ? 0 : by_voltage ? side * parts_.stall_torque : range.at(side);
    motor.along = place == AtLimit::along ? 1 : 0;
    const double push = at_other ? -outward.push : outward.push;
    motor.integrate = within || (motor.along == 0 && push < 0) ? 1 : 0;
  }
}

}  // namespace bbsim::model
