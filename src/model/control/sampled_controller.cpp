// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/control/sampled_controller.hpp"

#include <algorithm>

namespace bbsim::model {

BallSensor::BallSensor(const Sensor& sensor) : sensor_(sensor), noise_(sensor.seed) {
  // The seed of noise and jitter (sample_times.cpp), but another sequence.
  constexpr std::uint64_t other_sequence = 0x3c6ef372fe94f82aU;
  if (sensor.dropout > 0) dropouts_.emplace(sensor.seed + other_sequence);
}

Pair BallSensor::aligned(double x, double y) const {
  if (sensor_.is_aligned()) return {x, y};
  const std::array<double, 2> says = turned(sensor_, x, y);
  return {says[0] + sensor_.offset[0], says[1] + sensor_.offset[1]};
}

// Reads nothing, the last reading, or the corner of the area.
bool BallSensor::miss(Pair& seen) const {
  if (sensor_.on_miss == OnMiss::last && last_) {
    seen = *last_;
    return true;
  }
  if (sensor_.on_miss != OnMiss::edge) return false;
  seen = rounded(aligned(-(*sensor_.area)[0] / 2, -(*sensor_.area)[1] / 2));
  return true;
}

Pair BallSensor::rounded(const Pair& says) const {
  Pair seen{in_steps(says[0], sensor_.resolution), in_steps(says[1], sensor_.resolution)};
  if (sensor_.only) seen[*sensor_.only == 0 ? 1 : 0] = 0;
  return seen;
}

bool BallSensor::read(double x, double y, Pair& seen, bool firm) {
  Pair says = aligned(x, y);
  bool missed = !firm;
  // Draw for every sample, whatever it sees, so that runs with one seed have the same noise.
  if (sensor_.noise > 0) {
    for (double& coordinate : says) coordinate += sensor_.noise * noise_.normal();
  }
  if (dropouts_) missed = dropouts_->uniform() < sensor_.dropout;
  if (sensor_.area) {
    missed = missed || std::abs(x) > (*sensor_.area)[0] / 2 || std::abs(y) > (*sensor_.area)[1] / 2;
  }
  for (const auto& [x0, y0, x1, y1] : sensor_.dead_zones) {
    missed = missed || (x >= x0 && x <= x1 && y >= y0 && y <= y1);
  }
  if (missed && sensor_.on_miss != OnMiss::none) return miss(seen);
  seen = rounded(says);
  if (!missed && sensor_.on_miss == OnMiss::last) last_ = seen;
  return !missed;
}

namespace {

// The greatest multiple of a step within the limit, up to rounding.
double inward(double limit, double step) {
  return step > 0 && limit < unlimited ? std::floor(limit / step * (1 + 1e-12)) * step : limit;
}

}  // namespace

SampledController::SampledController(const SampledLoop& loop)
    : period_(loop.sampling.period),
      resolution_(loop.sampling.resolution),
      mechanism_(loop.mechanism) {
  law_.law = loop.law;
  law_.integrates = loop.law.integrates();
  law_.filter = loop.sampling.derivative_filter;
  // With a linkage, the servos' angles are rounded instead.
  const double step = loop.mechanism.none() || loop.legs ? loop.sampling.resolution : 0;
  law_.resolution = step;
  for (std::size_t i = 0; i < 2; ++i) {
    const CommandRange& limit = loop.limit[i];
    law_.limit[i] = {limit.low, limit.high};
    law_.sine[i] = {-1, 1};
    if (loop.law.kind == LawKind::gravity_compensation) {
      law_.sine[i] = {std::sin(limit.low), std::sin(limit.high)};
    }
    law_.reached[i] = {-inward(-limit.low, step), inward(limit.high, step)};
  }
  if (loop.mechanism.linkages.empty() || !(resolution_ > 0)) return;
  for (std::size_t i = 0; i < 2; ++i) {
    // Limits of a servo's angle, which may fall as the plane rises.
    const CommandRange& limit = loop.limit[i];
    const auto of = [&](double angle) {
      return std::isfinite(angle) ? loop.mechanism.linkages[i].command_for(angle) : angle;
    };
    const double a = of(limit.low), b = of(limit.high);
    if (!std::isfinite(a) || !std::isfinite(b)) continue;
    servo_[i] = {-inward(-std::min(a, b), resolution_), inward(std::max(a, b), resolution_)};
  }
}

Pair SampledController::command(const std::optional<Pair>& seen, const double (&servo)[4],
                                const std::array<Jet<double>, 2>& reference) {
  if (!seen) {
    since_.miss();
    return command_;
  }
  const double at[2] = {(*seen)[0], (*seen)[1]};
  double u[2];
  take_sample(law_, memory_, at, since_.elapsed(period_), !since_.any, servo, reference, u);
  since_.see();
  command_ = {u[0], u[1]};
  return command_;
}

Pair SampledController::within_limits(Pair command) const {
  double u[2] = {command[0], command[1]};
  keep_within_limits(law_, u);
  return {u[0], u[1]};
}

std::array<double, 3> SampledController::servo_commands(Pair command) const {
  if (mechanism_.none()) return {command[0], command[1], 0};
  std::array<double, 3> servo = mechanism_.commands_for(command);
  for (double& angle : servo) angle = in_steps(angle, resolution_);
  for (std::size_t i = 0; i < 2; ++i)
    servo[i] = std::clamp(servo[i], servo_[i].low, servo_[i].high);
  return servo;
}

}  // namespace bbsim::model
