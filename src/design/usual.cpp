// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "design/usual.hpp"

#include <algorithm>
#include <cmath>

#include "design/merit.hpp"
#include "design/multisine.hpp"

namespace bbsim::design {
namespace {

constexpr double quarter = turn / 4;

// A counterclockwise circle of the ball from (1, 0), at an arbitrary scale.
Motion circle_of(const Task& task, double frequency) {
  Motion motion;
  const bool tilts = task.plays == Plays::tilts;
  // phi accelerates the ball along x, theta against y. The ball's position is opposite to its
  // acceleration.
  const double sign = tilts ? -1 : 1;
  if (task.axes[0]) motion.sines[0] = {{sign, frequency, quarter, 0}};
  if (task.axes[1]) motion.sines[1] = {{1, frequency, 0, 0}};
  const Scenario scenario = task.family.read({});
  const double pull = scenario.gravity / (1 + scenario.ball.inertia_factor);
  const double radius = tilts ? pull / (frequency * frequency) : 1;
  if (task.axes[0]) motion.position[0] = radius;
  if (task.axes[1]) motion.velocity[1] = radius * frequency;
  return motion;
}

}  // namespace

std::optional<Circle> best_circle(const Task& task, const Experiment& experiment) {
  std::optional<Circle> best;
  double most = 0;
  const auto highest = static_cast<double>(highest_multiple(task.length, task.rate));
  // Multiples grow by at most a third, but by at least one.
  for (double multiple = 1; multiple <= highest && !task.is_stopped();
       multiple = std::max(multiple + 1, std::floor(multiple * 1.33))) {
    const double frequency = turn * multiple / task.length;
    const auto motion = experiment.within_limits(circle_of(task, frequency));
    if (!motion) continue;
    const double merit = merit_of(experiment.information(motion->motion).matrix);
    if (best && merit <= most) continue;
    best = Circle{motion->motion, frequency};
    most = merit;
  }
  return best;
}

std::optional<Motion> largest_step(const Task& task, const Experiment& experiment) {
  Motion motion;
  motion.step = {task.axes[0] ? 1.0 : 0.0, task.axes[1] ? 1.0 : 0.0};
  motion.step_start = task.length / 10;
  const auto scaled = experiment.within_limits(motion);
  if (!scaled) return {};
  return scaled->motion;
}

}  // namespace bbsim::design
