// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/hybrid/motor_limits.hpp"

#include <utility>

namespace bbsim::model {

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
