// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "design/design.hpp"

#include <cmath>

#include "base/error.hpp"
#include "base/short_number.hpp"
#include "design/choose.hpp"
#include "design/merit.hpp"
#include "design/usual.hpp"

namespace bbsim::design {
namespace {

[[noreturn]] void refuse_limits(const Task& task, const Experiment& experiment) {
  const auto still = experiment.use(Motion{});
  const std::string allowed = "; allowed: a rig that keeps the ball on the plate for " +
                              short_number(task.length) + " s, or a shorter --length";
  if (!still) throw InputError("the scenario does not run to its end without a motion" + allowed);
  if (still->greatest() > 1) {
    throw InputError("without a motion, the ball or the plate goes beyond its limits" + allowed);
  }
  throw InputError("found no motion within the limits" + allowed);
}

void refuse_idle_keys(const Task& task, const Eigen::VectorXd& effects) {
  // In units of noise; any real effect is larger.
  constexpr double least = 1e-6;
  for (Eigen::Index k = 0; k < effects.size(); ++k) {
    if (effects[k] > least) continue;
    std::string columns;
    for (const scenario::Column* const column : task.columns) {
      columns += (columns.empty() ? "" : ", ") + std::string(column->name);
    }
    throw InputError("--free: " + task.keys[static_cast<std::size_t>(k)].name +
                     ": has no effect on " + columns +
                     "; allowed: keys that the log's columns depend on");
  }
}

// Standard deviations in the keys' own units.
std::vector<double> deviations(const Task& task, const Eigen::MatrixXd& information) {
  std::vector<double> made = deviations_of(information);
  for (std::size_t k = 0; k < made.size(); ++k) made[k] *= std::abs(task.keys[k].slope(0));
  return made;
}

}  // namespace

Designed design(const Task& task, const std::function<ScenarioFamily(const Designed&)>& written) {
  const Experiment experiment(task);
  const auto circle = best_circle(task, experiment);
  // The circle shows which frequencies are informative.
  constexpr double usual_frequency = 3;  // rad/s
  const auto chosen = choose(task, experiment, circle ? circle->frequency : usual_frequency);
  Designed made;
  made.interrupted = task.is_stopped();
  if (made.interrupted) return made;
  if (!chosen) refuse_limits(task, experiment);
  made.motion = chosen->motion;
  for (double& at : made.motion.position) at = std::round(at * 1e3) / 1e3 + 0.0;  // placed by hand
  made.nominal = experiment.nominal();
  made.tried = chosen->tried;

  const ScenarioFamily family = written(made);
  const Experiment::Information information = experiment.information(family);
  refuse_idle_keys(task, information.effects);
  if (const auto use = experiment.use(family)) made.use = *use;
  made.windows = information.windows;
  made.numbers = information.numbers;
  const std::vector<double> own = deviations(task, information.matrix);
  for (std::size_t k = 0; k < own.size(); ++k) {
    const fit::FreeKey& key = task.keys[k];
    made.parameters.push_back({key.name, key.unit, key.value(0), own[k]});
  }
  if (circle) {
    made.circle_frequency = circle->frequency;
    const auto others = deviations(task, experiment.information(circle->motion).matrix);
    for (std::size_t k = 0; k < others.size(); ++k) made.parameters[k].circle = others[k];
  }
  if (const auto step = largest_step(task, experiment)) {
    const auto others = deviations(task, experiment.information(*step).matrix);
    for (std::size_t k = 0; k < others.size(); ++k) made.parameters[k].step = others[k];
  }
  made.interrupted = task.is_stopped();
  return made;
}

}  // namespace bbsim::design
