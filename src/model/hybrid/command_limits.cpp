// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/hybrid/command_limits.hpp"

#include <algorithm>
#include <cmath>

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

}  // namespace bbsim::model
