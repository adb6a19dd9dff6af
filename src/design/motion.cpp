// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "design/motion.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

namespace bbsim::design {
namespace {

// Rows at which a spline reproduces the motion to some parts in ten thousand; times in s.
constexpr double rows_per_period = 16, most_time_of_row = 0.1, step_row = 0.02;

double highest_frequency(const Motion& motion) {
  double highest = 0;
  for (const auto& axis : motion.sines) {
    for (const Sinusoid& sine : axis) highest = std::max(highest, std::abs(sine.frequency));
  }
  return highest;
}

std::vector<double> row_times(const Motion& motion, double length) {
  constexpr double turn = 6.283185307179586;
  double row = most_time_of_row;
  const double highest = highest_frequency(motion);
  if (highest > 0) row = std::min(row, turn / highest / rows_per_period);
  if (motion.step != Pair{0, 0}) row = std::min(row, step_row);
  const double count = std::max(8.0, std::ceil(length / row));
  std::vector<double> times;
  for (double i = 0; i <= count; ++i) times.push_back(i * length / count);
  return times;
}

TableChange change_of(const Profile& profile) {
  if (profile.size() != 1) return {};
  const auto* const table = std::get_if<Table>(&profile.front());
  if (table == nullptr) return {};
  // A delayed table has one more row at either end.
  const std::size_t first = std::isinf(table->times.front()) ? 1 : 0;
  TableChange change;
  change.delay = table->times[first];
  change.offset = table->values[first];
  change.scale = table->values[first + 1] - change.offset;
  return change;
}

void play_profile(const Motion& motion, std::size_t axis, const TableChange& nominal, double length,
                  Profile& profile) {
  if (profile.size() != 1 || !std::holds_alternative<Table>(profile.front())) return;
  const TableChange change = change_of(profile);
  const double ratio = change.scale / nominal.scale;
  profile = {change.offset - ratio * nominal.offset};
  for (Sinusoid sine : motion.sines[axis]) {
    sine.amplitude *= ratio;
    sine.phase -= sine.frequency * change.delay;
    profile.emplace_back(sine);
  }
  if (motion.step[axis] == 0) return;
  Table table;
  table.times = row_times(motion, length);
  Motion alone;
  alone.step = motion.step;
  alone.step_start = motion.step_start;
  for (const double t : table.times) {
    table.values.push_back(ratio * alone.value(axis, t - change.delay));
  }
  profile.emplace_back(std::move(table));
}

}  // namespace

double Motion::value(std::size_t axis, double t) const {
  double sum = 0;
  for (const Sinusoid& sine : sines[axis]) {
    sum += sine.offset + sine.amplitude * std::sin(sine.frequency * t + sine.phase);
  }
  // The smoothest step: the quintic of least jerk.
  const double s = std::clamp((t - step_start) / rise_time, 0.0, 1.0);
  return sum + step[axis] * s * s * s * (10 + s * (6 * s - 15));
}

Motion Motion::scaled(double by) const {
  Motion made = *this;
  for (std::size_t i = 0; i < 2; ++i) {
    for (Sinusoid& sine : made.sines[i]) {
      sine.amplitude *= by;
      sine.offset *= by;
    }
    made.step[i] *= by;
    made.position[i] *= by;
    made.velocity[i] *= by;
  }
  return made;
}

Placeholder placeholder(double length) {
  return {{0, length / 3, length * 2 / 3, length}, {0, 1, 0, 0}};
}

std::array<TableChange, 2> changes_of(const Scenario& scenario) {
  if (const auto* const commands = commands_of(scenario)) {
    return {change_of(commands->phi), change_of(commands->theta)};
  }
  if (!scenario.gimbal.motion) return {};
  return {change_of(scenario.gimbal.motion->phi), change_of(scenario.gimbal.motion->theta)};
}

void play(const Motion& motion, Plays plays, const std::array<TableChange, 2>& nominal,
          double length, Scenario& scenario) {
  scenario.ball.position = motion.position;
  scenario.ball.velocity = motion.velocity;
  if (plays == Plays::tilts) {
    auto* const commands = commands_of(scenario);
    Profile& phi = commands != nullptr ? commands->phi : scenario.gimbal.motion->phi;
    Profile& theta = commands != nullptr ? commands->theta : scenario.gimbal.motion->theta;
    play_profile(motion, 0, nominal[0], length, phi);
    play_profile(motion, 1, nominal[1], length, theta);
    return;
  }
  TableReference table;
  table.times = row_times(motion, length);
  for (const double t : table.times) {
    table.x.push_back(motion.value(0, t));
    table.y.push_back(motion.value(1, t));
  }
  scenario.controller->reference = std::move(table);
}

double command(const Motion& motion, std::size_t axis, const TableChange& nominal, double t) {
  return (motion.value(axis, t) - nominal.offset) / nominal.scale;
}

}  // namespace bbsim::design
