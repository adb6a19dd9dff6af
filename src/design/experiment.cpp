// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "design/experiment.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "fit/fit.hpp"
#include "fit/windows_fit.hpp"
#include "scenario/columns.hpp"
#include "sweep/clock_shift.hpp"

namespace bbsim::design {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

std::vector<const scenario::Column*> columns_named(const std::vector<std::string>& names) {
  std::vector<const scenario::Column*> columns;
  for (const std::string& name : names) columns.push_back(scenario::find_column(name));
  return columns;
}

std::vector<double> even_times(double length, double step) {
  const double count = std::max(8.0, std::ceil(length / step * (1 - 1e-9)));
  std::vector<double> times;
  for (double i = 0; i <= count; ++i) times.push_back(i * length / count);
  return times;
}

// Rounding has no derivative, and random effects are not the log's own noise.
void make_smooth(Scenario& scenario, bool keep_dead_band) {
  if (scenario.controller && scenario.controller->sampling) {
    scenario.controller->sampling->resolution = 0;
    scenario.controller->sampling->jitter = 0;
  }
  if (scenario.controller && scenario.controller->sensor) {
    Sensor& sensor = *scenario.controller->sensor;
    sensor.resolution = sensor.noise = sensor.dropout = 0;
  }
  if (keep_dead_band) return;
  for (auto* const servo : {&scenario.gimbal.servo, &scenario.gimbal.theta_servo}) {
    if (*servo) (*servo)->dead_band = 0;
  }
}

}  // namespace

Experiment::Experiment(const Task& task) : task_(task) {
  log_.name = "the log";
  const auto rows = static_cast<std::size_t>(std::floor(task.length * task.rate * (1 + 1e-9)));
  for (std::size_t i = 0; i <= rows; ++i) {
    log_.times.push_back(std::min(static_cast<double>(i) / task.rate, task.length));
  }
  log_.values.assign(task.columns.size(), std::vector<double>(log_.times.size(), 0));
  for (const fit::FreeKey& key : task.keys) {
    dead_band_is_free_ = dead_band_is_free_ || key.name.ends_with("dead_band");
  }
  nominal_ = changes_of(scene(task.family, [](Scenario&) {}));
}

Scenario Experiment::scene(const ScenarioFamily& family, const Adapt& adapt) const {
  std::vector<ScenarioFamily::Setting> settings;
  for (const fit::FreeKey& key : task_.keys) settings.push_back(key.setting(key.start));
  Scenario scenario = family.read(settings);
  adapt(scenario);
  return fit::prepared(std::move(scenario));
}

Experiment::Adapt Experiment::playing(const Motion& motion) const {
  return [this, &motion](Scenario& scenario) {
    play(motion, task_.plays, nominal_, task_.length, scenario);
    make_smooth(scenario, dead_band_is_free_);
  };
}

Experiment::Adapt Experiment::as_it_is() const {
  return [this](Scenario& scenario) { make_smooth(scenario, dead_band_is_free_); };
}

std::optional<Use> Experiment::use(const ScenarioFamily& family, const Adapt& adapt) const {
  constexpr double step = 0.02;  // s; the fastest sine takes 0.3 s
  const Scenario scenario = scene(family, adapt);
  const std::vector<double> times = even_times(task_.length, step);
  std::string why;
  const std::vector<double> values =
      fit::run_window(sweep::from_time(scenario, 0, task_.length), fit::start_of(scenario), times,
                      columns_named(columns_of_use(task_.limits)), why);
  if (values.empty()) return {};
  return use_of(task_.limits, values);
}

std::optional<Use> Experiment::use(const Motion& motion) const {
  return use(task_.family, playing(motion));
}

std::optional<Use> Experiment::use(const ScenarioFamily& family) const {
  return use(family, as_it_is());
}

std::optional<Experiment::Scaled> Experiment::within_limits(Motion shape) const {
  // Starts with an arbitrary scale: a hundredth, in radians or meters.
  double size = 0;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    double sum = std::abs(shape.step[axis]);
    for (const Sinusoid& sine : shape.sines[axis]) sum += std::abs(sine.amplitude);
    size = std::max(size, sum);
  }
  if (!(size > 0)) return {};
  constexpr double aim = 0.99, close = 0.97;
  constexpr int most_rounds = 10;
  std::optional<Scaled> best;
  double scale = 0.01 / size;
  for (int round = 0; round < most_rounds; ++round) {
    const Motion motion = shape.scaled(scale);
    const auto used = use(motion);
    const double greatest = used ? used->greatest() : INFINITY;
    if (greatest <= 1 && (!best || scale > best->scale)) best = Scaled{motion, scale};
    if (greatest <= 1 && greatest >= close) break;
    // The path has the most room in the middle of the plate.
    if (used && shape.centered) {
      for (std::size_t i = 0; i < 2; ++i) shape.position[i] -= used->middle[i] / scale;
    }
    // The use is almost proportional to the scale, except for parts that do not scale, such as an
    // offset.
    const double factor = std::isfinite(greatest) ? aim / std::max(greatest, 1e-6) : 0.2;
    scale *= std::clamp(factor, 0.1, 100.0);
  }
  return best;
}

Experiment::Information Experiment::information(const ScenarioFamily& family,
                                                const Adapt& adapt) const {
  const bool whole = task_.plays == Plays::reference && !task_.window;
  fit::Task of_fit{family, task_.keys, task_.columns, {log_}};
  of_fit.threads = task_.threads;
  of_fit.adapt = adapt;
  const std::size_t starts =
      fit::start_coordinates(task_.columns, task_.plays == Plays::reference && !whole).size();
  const double length = whole ? 2 * task_.length : task_.window.value_or(fit::usual_window);
  std::vector<fit::Window> windows = fit::cut({log_}, length, 0, starts);

  // The windows begin at states of the run.
  const Scenario scenario = scene(family, adapt);
  std::string why;
  const std::vector<double> run = fit::run_window(
      sweep::from_time(scenario, 0, task_.length), fit::start_of(scenario), log_.times,
      columns_named({"x", "y", "vx", "vy", "phi", "theta", "phi_rate", "theta_rate", "spin"}), why);
  Information made;
  const auto keys = static_cast<Index>(task_.keys.size());
  made.matrix = Eigen::MatrixXd::Zero(keys, keys);
  made.effects = VectorXd::Zero(keys);
  if (run.empty() || windows.empty()) return made;
  std::vector<fit::Start> at;
  for (const fit::Window& window : windows) {
    fit::Start start = fit::start_of(scenario);
    const auto row = static_cast<std::size_t>(std::ranges::lower_bound(log_.times, window.begin) -
                                              log_.times.begin());
    for (std::size_t i = 0; i < start.size() && !window.first; ++i) {
      start[i] = run[i * log_.times.size() + row];
    }
    at.push_back(start);
  }
  fit::WindowsFit fit(of_fit, std::move(windows));
  fit.set_noise(task_.noise);
  const auto derivatives = fit.derivatives(VectorXd::Zero(keys), at);
  made.matrix = derivatives.projected.transpose() * derivatives.projected;
  made.effects = derivatives.free_norms;
  made.windows = at.size();
  made.numbers = fit.size();
  return made;
}

Experiment::Information Experiment::information(const Motion& motion) const {
  return information(task_.family, playing(motion));
}

Experiment::Information Experiment::information(const ScenarioFamily& family) const {
  return information(family, as_it_is());
}

}  // namespace bbsim::design
