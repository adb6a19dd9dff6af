// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "fit/fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "base/error.hpp"
#include "base/short_number.hpp"
#include "fit/ideal_rig.hpp"
#include "fit/minimize.hpp"
#include "fit/profile.hpp"
#include "fit/residuals.hpp"
#include "fit/scale_keys.hpp"
#include "fit/student.hpp"
#include "fit/suggestion.hpp"
#include "fit/windows_fit.hpp"
#include "model/dense.hpp"
#include "sweep/clock_shift.hpp"

namespace bbsim::fit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::vector<double> rms_of(const WindowsFit& windows, const VectorXd& residuals) {
  std::vector<double> rms;
  for (const ColumnSize& size : sizes_of(windows, residuals)) rms.push_back(size.rms);
  return rms;
}

// Uniform number from 0 to 1, the same with every standard library.
double uniform(std::mt19937_64& random) {
  return std::ldexp(static_cast<double>(random() >> 11), -53);
}

// Standard deviation of each column; differences below 1e-9 of it are rounding.
std::vector<double> spreads_of(const Task& task) {
  std::vector<double> spreads;
  for (std::size_t c = 0; c < task.columns.size(); ++c) {
    double sum = 0, squares = 0, count = 0;
    for (const Log& log : task.logs) {
      for (const double value : log.values[c]) {
        if (!std::isfinite(value)) continue;
        sum += value;
        squares += value * value;
        count += 1;
      }
    }
    const double mean = count > 0 ? sum / count : 0;
    const double variance = count > 0 ? squares / count - mean * mean : 0;
    spreads.push_back(std::max(std::sqrt(std::max(variance, 0.0)), 1e-9));
  }
  return spreads;
}

class Fit {
 public:
  Fit(const Task& task, std::vector<Window> windows, Fitted& made)
      : task_(task),
        made_(made),
        windows_(task_, std::move(windows)),
        spreads_(spreads_of(task_)),
        u_(VectorXd::Zero(at(task_.keys.size()))) {}

  // Returns false if interrupted; the result is then the best so far.
  bool run() {
    windows_.set_noise(spreads_);
    residuals_ = windows_.residuals(u_, true);
    if (is_stopped(task_)) return false;
    before_ = rms_of(windows_, residuals_);
    refuse_idle_keys();
    mirror_axes();
    if (!choose_start()) return false;
    residuals_ = windows_.residuals(u_);
    set_noise();
    return settle_weights() && (!task_.continuity || join());
  }

  // Whether an interrupted run has any result.
  [[nodiscard]] bool has_begun() const { return !before_.empty(); }

  void report() {
    windows_.finish();
    residuals_ = windows_.residuals(u_);
    const std::vector<ColumnSize> sizes = sizes_of(windows_, residuals_);
    const std::vector<double> correlations = correlations_of(windows_, residuals_);
    const std::vector<Outliers> outliers = outliers_of(windows_, residuals_, sizes);
    for (std::size_t c = 0; c < task_.columns.size(); ++c) {
      ColumnResidual one{std::string(task_.columns[c]->name), std::string(task_.columns[c]->unit)};
      one.before = before_[c];
      one.rms = sizes[c].rms;
      one.correlation = correlations[c];
      const bool is_exact = one.rms <= 1e-6 * spreads_[c];
      if (!is_exact && outliers[c].count > 0) {
        one.outliers = outliers[c].count;
        one.outlier_log = task_.logs[outliers[c].log].name;
        one.outlier_time = outliers[c].time;
      }
      made_.columns.push_back(one);
      // Fitting the starts reduces correlation, so white residuals rarely reach this.
      made_.white = made_.white && (is_exact || correlations[c] < 3 / std::sqrt(sizes[c].count));
    }
    const std::vector<double> ideal = ideal_rms(windows_.windows());
    for (std::size_t c = 0; c < ideal.size(); ++c) made_.columns[c].ideal = ideal[c];
    report_parameters();
    if (!made_.white) made_.suggestion = suggestion(task_, windows_, u_);
  }

  // Reports the held-out windows at the fitted values.
  void report_held(std::vector<Window> held) {
    if (held.empty()) return;
    const std::vector<double> ideal = ideal_rms(held);
    for (std::size_t c = 0; c < ideal.size(); ++c) made_.columns[c].held_ideal = ideal[c];
    WindowsFit others(task_, std::move(held));
    others.finish();
    others.set_noise(windows_.noise());
    const auto keep = [&](const VectorXd& u, std::optional<double> ColumnResidual::*held) {
      const VectorXd residuals = others.residuals(u);
      if ((residuals.array() == WindowsFit::far).any()) return;  // a window does not run
      const std::vector<double> rms = rms_of(others, residuals);
      for (std::size_t c = 0; c < rms.size(); ++c) made_.columns[c].*held = rms[c];
    };
    keep(VectorXd::Zero(u_.size()), &ColumnResidual::held_before);
    keep(u_, &ColumnResidual::held);
  }

  void report_series(const std::vector<Window>& held) {
    made_.series = windows_.series(u_);
    if (held.empty()) return;
    WindowsFit others(task_, held);
    others.finish();
    others.set_noise(windows_.noise());
    for (WindowSeries& one : others.series(u_)) made_.series.push_back(std::move(one));
  }

  [[nodiscard]] std::size_t size() const { return windows_.size(); }

 private:
  // Residuals of an ideal rig; empty if there is no such rig or it does not run.
  [[nodiscard]] std::vector<double> ideal_rms(const std::vector<Window>& windows) const {
    const auto ideal = ideal_rig(task_.family.read(task_.logs.front().settings));
    const auto lacks = [&](const scenario::Column* column) {
      return static_cast<bool>(scenario::missing(*column, *ideal));
    };
    if (!ideal || std::ranges::any_of(task_.columns, lacks)) return {};
    Task task = task_;
    task.keys.clear();
    task.adapt = [this](Scenario& scenario) {
      if (task_.adapt) task_.adapt(scenario);
      scenario = *ideal_rig(scenario);
    };
    WindowsFit its(task, windows);
    its.finish();
    its.set_noise(windows_.noise());
    try {
      const VectorXd free = its.residuals(VectorXd{}, true);
      if (!windows_.is_joined() || windows.front().held) return rms_of(its, free);
      its.join();
      return rms_of(its, its.residuals(VectorXd{}, true));
    } catch (const InputError&) {
      return {};
    }
  }

  [[nodiscard]] std::vector<Index> all_keys() const {
    std::vector<Index> keys;
    for (Index k = 0; k < u_.size(); ++k) keys.push_back(k);
    return keys;
  }

  // Continues from the best of several starts; the first is the scenario's. False if interrupted.
  bool choose_start() {
    std::mt19937_64 random(1);
    const VectorXd first = u_;
    VectorXd best = u_;
    double least = unlimited;
    for (std::size_t start = 0; start < task_.starts && task_.starts > 1; ++start) {
      VectorXd u = first;
      for (Index k = 0; start > 0 && k < u.size(); ++k) {
        const FreeKey& key = task_.keys[static_cast<std::size_t>(k)];
        const bool bounded = std::isfinite(key.lower) && std::isfinite(key.upper) &&
                             !(key.logarithmic && key.lower == 0);
        // Without bounds: a factor of two, or the key's scale.
        const double reach = key.logarithmic ? std::log(2.0) : 1;
        const double from = bounded ? key.number(key.lower) : first[k] - reach;
        const double to = bounded ? key.number(key.upper) : first[k] + reach;
        u[k] = from + (to - from) * uniform(random);
      }
      windows_.restart();
      if (!minimize(task_, windows_, all_keys(), u, made_.iterations)) return false;
      const double cost = windows_.residuals(u).squaredNorm();
      if (!(cost < least)) continue;
      least = cost;
      best = u_ = u;
    }
    if (task_.starts > 1) windows_.restart();
    return !is_stopped(task_);
  }

  // Joins each chain of windows to one trajectory, from the nearby optimum of free windows.
  bool join() {
    windows_.join();
    residuals_ = windows_.residuals(u_, true);
    if (is_stopped(task_)) return false;
    set_noise();
    return settle_weights();
  }

  // Optimizes the keys with weights that follow the residuals. False if interrupted.
  bool settle_weights() {
    const int most_rounds = task_.robust ? 40 : 12;
    // Changes of the weights move the keys little, but the last round must be exact.
    bool exact = true;
    for (int round = 0; round < most_rounds; ++round) {
      if (exact || !follow(task_, windows_, u_)) {
        if (!minimize(task_, windows_, all_keys(), u_, made_.iterations)) return false;
        exact = true;
      }
      residuals_ = windows_.residuals(u_);
      const double reweighted = task_.robust ? set_weights() : 0;
      const bool is_settled = std::max(set_noise(), reweighted) < (task_.robust ? 1e-4 : 1e-7);
      if (is_settled && exact) break;
      exact = is_settled || round + 2 == most_rounds;
    }
    residuals_ = windows_.residuals(u_);
    return !is_stopped(task_);
  }

  void refuse_idle_keys() {
    // The noise is still set to the columns' spreads.
    const VectorXd changes = scale_keys(task_, windows_, u_);
    for (Index k = 0; k < changes.size(); ++k) {
      if (!(changes[k] > 1e-7)) refuse_idle(task_.keys[static_cast<std::size_t>(k)]);
    }
  }

  // Mirrors the initial scale of a column if that fits better: on the way from 1 to -1 the scale
  // would pass 0, where the log determines no other key.
  void mirror_axes() {
    double cost = residuals_.squaredNorm();
    bool tried = false;
    for (Index k = 0; k < u_.size(); ++k) {
      const FreeKey& key = task_.keys[static_cast<std::size_t>(k)];
      if (key.of != FreeKey::Of::scale || key.logarithmic || -key.start < key.lower) continue;
      VectorXd mirrored = u_;
      mirrored[k] = key.number(-key.start);
      windows_.restart();  // the slopes by the starts are mirrored, too
      tried = true;
      const double its = windows_.residuals(mirrored).squaredNorm();
      if (!(its < cost)) continue;
      cost = its;
      u_ = mirrored;
    }
    if (tried) windows_.restart();
  }

  [[noreturn]] void refuse_idle(const FreeKey& key) const {
    std::string columns;
    for (const scenario::Column* const column : task_.columns) {
      columns += (columns.empty() ? "" : ", ") + std::string(column->name);
    }
    throw InputError("--free: " + key.name + ": has no effect on " + columns +
                     "; allowed: keys that the compared columns depend on");
  }

  [[nodiscard]] double degrees_of_freedom() const {
    return std::max(1.0, static_cast<double>(windows_.size()) -
                             static_cast<double>(windows_.starts() + task_.keys.size()));
  }

  // Estimates each column's noise from its residuals. Returns how much the columns' weights change
  // relative to each other.
  double set_noise() {
    const double share = degrees_of_freedom() / static_cast<double>(windows_.size());
    std::vector<double> noise;
    double least = unlimited, most = 0;
    const std::vector<ColumnSize> sizes = sizes_of(windows_, residuals_);
    for (std::size_t c = 0; c < sizes.size(); ++c) {
      const double size = task_.robust ? sizes[c].usual : sizes[c].rms;
      noise.push_back(std::max(size / std::sqrt(share), 1e-9 * spreads_[c]));
      const double change = noise[c] / windows_.noise()[c];
      least = std::min(least, change);
      most = std::max(most, change);
    }
    // The weights belong to the noise they were computed with.
    windows_.set_noise(std::move(noise));
    return most / least - 1;
  }

  // Returns the largest change of a weight.
  double set_weights() {
    const VectorXd weights = huber_weights(residuals_.cwiseQuotient(windows_.weights()));
    const double change = (weights - windows_.weights()).cwiseAbs().maxCoeff();
    windows_.set_weights(weights);
    return change;
  }

  // Variance of a residual in the units of the fit; with Huber's loss, that of its influence
  // (Huber, Robust Statistics, 1981, section 7.6).
  [[nodiscard]] double scatter() const {
    if (!task_.robust) return residuals_.squaredNorm() / degrees_of_freedom();
    const VectorXd influence = residuals_.cwiseProduct(windows_.weights());
    const auto within = static_cast<double>((windows_.weights().array() >= 1).count());
    return influence.squaredNorm() / degrees_of_freedom() /
           std::max(within / static_cast<double>(windows_.size()), 0.1);
  }

  void report_parameters() {
    const WindowsFit::Derivatives derivatives = windows_.derivatives(u_);
    const MatrixXd& jacobian = derivatives.projected;
    const VectorXd sizes = derivatives.free_norms.cwiseMax(1e-300);
    const MatrixXd scaled = jacobian * sizes.cwiseInverse().asDiagonal();
    const model::SingularValues svd =
        model::singular_values(scaled.transpose() * scaled, Eigen::ComputeFullV);
    // Squares of J's singular values. Below 1e-4 of the largest, those are errors of differences.
    const VectorXd& values = svd.values;
    const double least = 1e-8 * std::max(values[0], 1e-300);
    const Index keys = u_.size();
    MatrixXd covariance = MatrixXd::Zero(keys, keys);
    std::vector<char> told(static_cast<std::size_t>(keys), 1);
    for (Index j = 0; j < keys; ++j) {
      const VectorXd direction = svd.v.col(j);
      if (values[j] > least) {
        covariance += direction * direction.transpose() / values[j];
        continue;
      }
      for (Index k = 0; k < keys; ++k) {
        if (std::abs(direction[k]) > 0.02) told[static_cast<std::size_t>(k)] = 0;
      }
      made_.untold.push_back(words_for(direction.cwiseQuotient(sizes), direction));
    }
    covariance = sizes.cwiseInverse().asDiagonal() * covariance * sizes.cwiseInverse().asDiagonal();
    const double variance = scatter();
    const double t = student_95(degrees_of_freedom());
    Profiles profiles(task_, windows_, u_, derivatives);
    for (Index k = 0; k < keys; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const FreeKey& key = task_.keys[i];
      Parameter one;
      one.key = key.name;
      one.unit = key.unit;
      one.start = key.start;
      one.estimate = key.value(u_[k]);
      one.told = told[i] != 0;
      one.at_bound = one.estimate == key.lower || one.estimate == key.upper;
      if (one.told) {
        one.sd = std::sqrt(covariance(k, k) * variance) * std::abs(key.slope(u_[k]));
        const Ends ends = profiles.ends(k, t * t * variance);
        one.low = key.value(ends.low);
        one.high = key.value(ends.high);
      } else {
        one.sd = one.high = unlimited;
        one.low = -unlimited;
      }
      made_.parameters.push_back(one);
      std::vector<double> correlations;
      for (Index other = 0; other < keys; ++other) {
        const bool both = one.told && told[static_cast<std::size_t>(other)] != 0;
        correlations.push_back(both ? covariance(k, other) /
                                          std::sqrt(covariance(k, k) * covariance(other, other))
                                    : std::numeric_limits<double>::quiet_NaN());
      }
      made_.correlations.push_back(std::move(correlations));
    }
  }

  // "a and b cannot be told apart: the log stays the same with a +1 %, b -1 %"
  [[nodiscard]] std::string words_for(const VectorXd& change, const VectorXd& weight) const {
    std::vector<Index> members;
    for (Index k = 0; k < change.size(); ++k) {
      if (std::abs(weight[k]) > 0.02) members.push_back(k);
    }
    if (members.size() == 1) {
      return task_.keys[static_cast<std::size_t>(members[0])].name +
             " is not determined by the log: other starts of the windows have the same effect";
    }
    std::string names, changes;
    // Scales the first key's change to 1 %, or to a hundredth of its scale.
    const double unit = 0.01 / change[members[0]];
    for (const Index k : members) {
      const FreeKey& key = task_.keys[static_cast<std::size_t>(k)];
      const double by = change[k] * unit;
      names += (names.empty() ? "" : k == members.back() ? " and " : ", ") + key.name;
      const std::string sign = by < 0 ? "-" : "+";
      const std::string size = key.logarithmic ? rounded(100 * std::abs(by), 3) + " %"
                                               : rounded(std::abs(by) * key.scale, 3) +
                                                     (key.unit.empty() ? "" : " " + key.unit);
      changes += (changes.empty() ? "" : ", ") + key.name + " " + sign + size;
    }
    return names + " cannot be told apart: the log stays the same with " + changes;
  }

  Task task_;
  Fitted& made_;
  WindowsFit windows_;
  std::vector<double> spreads_, before_;
  VectorXd u_, residuals_;
};

// Drops rows in which a delayed sensor shows times before the window, which no run covers.
void drop_rows_before(double time, Window& window) {
  const auto kept = std::ranges::lower_bound(window.times, time) - window.times.begin();
  window.times.erase(window.times.begin(), window.times.begin() + kept);
  for (auto& column : window.values) column.erase(column.begin(), column.begin() + kept);
}

// Refuses states that a window's start lacks: it has those of ball and gimbal only.
void require_whole_starts(const Scenario& scenario) {
  const auto refuse = [](const std::string& found) {
    throw InputError("--continuity: found " + found +
                     ", whose state is not part of a window's start; allowed: scenes with no state "
                     "but that of the ball and of the gimbal");
  };
  const bool is_loop = scenario.controller && commands_of(scenario) == nullptr;
  if (is_loop && scenario.controller->sampling) refuse("a sampled controller");
  if (is_loop && scenario.controller->law == Law::pid) refuse("an integral in the controller");
  if (scenario.ball.rotation || (scenario.events.slip && scenario.events.slip->sliding)) {
    refuse("a ball that slides");
  }
  for (const auto& servo : {scenario.gimbal.servo, scenario.gimbal.theta_servo}) {
    if (is_loop && servo && servo->backlash > 0) refuse("backlash");
  }
}

// Refuses windows beyond the scenario's tables, where splines would run away.
void require_tables(const Task& task, const std::vector<Window>& windows) {
  std::vector<sweep::Span> spans;
  for (const Log& log : task.logs) {
    spans.push_back(sweep::span_of_tables(task.family.read(log.settings)));
  }
  for (const Window& window : windows) {
    const Log& log = task.logs[window.log];
    const sweep::Span& span = spans[window.log];
    const double end = window.begin + window.times.back();
    const double slack = 1e-6 * std::max(1.0, std::abs(end));
    if (window.begin >= span.from - slack && end <= span.to + slack) continue;
    throw InputError(log.name + ": found rows from t = " + short_number(window.begin) + " to " +
                     short_number(end) + " s; allowed: times that the scenario's tables cover, " +
                     short_number(span.from) + " to " + short_number(span.to) +
                     " s; --time-offset moves the log");
  }
}

}  // namespace

Fitted fit(const Task& task) {
  const Scenario scenario = task.family.read(task.logs.front().settings);
  Fitted made;
  // Feedback keeps errors small over whole logs and carries on states that no log shows.
  const bool whole_logs = scenario.controller && commands_of(scenario) == nullptr && !task.window &&
                          task.hold_out == 0 && !task.continuity;
  made.window = whole_logs ? unlimited : task.window.value_or(usual_window);
  const std::size_t coordinates =
      start_coordinates(task.columns, begins_anywhere(scenario) && !whole_logs).size();
  double most_delay = 0;
  for (const FreeKey& key : task.keys) {
    if (key.of == FreeKey::Of::delay) most_delay = key.upper;
  }
  std::vector<Window> windows, held;
  double longest = 0;
  for (const Log& log : task.logs) {
    if (!log.times.empty()) longest = std::max(longest, log.times.back() - log.times.front());
  }
  for (Window& window :
       cut(task.logs, std::min(made.window, 2 * longest + 1), task.hold_out, coordinates)) {
    drop_rows_before(most_delay, window);
    if (window.times.size() > 1) (window.held ? held : windows).push_back(std::move(window));
  }
  if (task.continuity) {
    require_whole_starts(scenario);
    find_joints(windows);
    made.joints = static_cast<std::size_t>(std::ranges::count_if(windows, &Window::goes_on));
  }
  made.windows = windows.size();
  made.held = held.size();
  std::size_t numbers = 0;
  for (const Window& window : windows) {
    for (const auto& column : window.values) {
      numbers += static_cast<std::size_t>(
          std::ranges::count_if(column, [](double value) { return std::isfinite(value); }));
    }
  }
  made.numbers = numbers;
  const std::size_t unknowns = windows.size() * coordinates + task.keys.size();
  if (numbers <= unknowns) {
    throw InputError(
        "the logs have " + std::to_string(numbers) + " numbers in " +
        std::to_string(windows.size()) + " windows; allowed: more than the " +
        std::to_string(unknowns) +
        " that are sought, starts included; use a longer --window or fewer --free keys");
  }
  require_tables(task, windows);
  require_tables(task, held);
  Fit fit(task, std::move(windows), made);
  made.interrupted = !fit.run();
  if (!fit.has_begun()) return made;
  fit.report();
  if (task.with_series) fit.report_series(held);
  fit.report_held(std::move(held));
  return made;
}

}  // namespace bbsim::fit
