// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "fit/fit.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <unsupported/Eigen/LevenbergMarquardt>
#include <utility>

#include "base/error.hpp"
#include "base/short_number.hpp"
#include "fit/clock_shift.hpp"
#include "fit/student.hpp"
#include "fit/windows_fit.hpp"

namespace bbsim::fit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double unlimited = std::numeric_limits<double>::infinity();

Index at(std::size_t i) {
  return static_cast<Index>(i);
}

// The problem as Eigen's minimizer sees it, in the keys that may move.
class Functor : public Eigen::DenseFunctor<double> {
 public:
  Functor(const Task& task, WindowsFit& windows, VectorXd& u, std::vector<Index> moving,
          std::size_t& iterations)
      : DenseFunctor(static_cast<int>(moving.size()), static_cast<int>(windows.size())),
        task_(task),
        windows_(windows),
        u_(u),
        moving_(std::move(moving)),
        iterations_(iterations) {}

  int operator()(const VectorXd& v, VectorXd& residuals) {
    residuals = windows_.residuals(whole(v));
    return is_stopped() ? -1 : 0;
  }

  int df(const VectorXd& v, MatrixXd& jacobian) {
    const MatrixXd projected = windows_.derivatives(whole(v)).projected;
    jacobian.resize(projected.rows(), at(moving_.size()));
    for (std::size_t i = 0; i < moving_.size(); ++i) {
      jacobian.col(at(i)) = projected.col(moving_[i]);
    }
    ++iterations_;
    if (task_.progress) {
      const auto done = static_cast<double>(iterations_);
      task_.progress(done / (done + 5), "iteration " + std::to_string(iterations_));
    }
    return is_stopped() ? -1 : 0;
  }

  [[nodiscard]] VectorXd whole(const VectorXd& v) const {
    VectorXd u = u_;
    for (std::size_t i = 0; i < moving_.size(); ++i) u[moving_[i]] = v[at(i)];
    return u;
  }

 private:
  [[nodiscard]] bool is_stopped() const {
    return task_.stop != nullptr && task_.stop->load(std::memory_order_relaxed);
  }

  const Task& task_;
  WindowsFit& windows_;
  const VectorXd& u_;
  std::vector<Index> moving_;
  std::size_t& iterations_;
};

// The sum of squares of each column's residuals, in SI, and how many there are.
struct Squares {
  std::vector<double> sum, count;
};
Squares squares_of(const WindowsFit& windows, const VectorXd& residuals) {
  const std::size_t columns = windows.noise().size();
  Squares made{std::vector<double>(columns, 0), std::vector<double>(columns, 0)};
  for (std::size_t i = 0; i < windows.size(); ++i) {
    const std::size_t c = windows.columns_of_rows()[i];
    const double residual = residuals[at(i)] * windows.noise()[c];
    made.sum[c] += residual * residual;
    made.count[c] += 1;
  }
  return made;
}

std::vector<double> rms_of(const WindowsFit& windows, const VectorXd& residuals) {
  const Squares squares = squares_of(windows, residuals);
  std::vector<double> rms;
  for (std::size_t c = 0; c < squares.sum.size(); ++c) {
    rms.push_back(squares.count[c] > 0 ? std::sqrt(squares.sum[c] / squares.count[c]) : 0);
  }
  return rms;
}

// The correlation of neighboring residuals of each column within windows.
std::vector<double> correlations_of(const WindowsFit& windows, const VectorXd& residuals) {
  const std::size_t columns = windows.noise().size();
  std::vector<double> products(columns, 0), squares(columns, 0);
  for (std::size_t w = 0; w < windows.windows().size(); ++w) {
    for (std::size_t i = windows.first_row(w); i < windows.first_row(w + 1); ++i) {
      const std::size_t c = windows.columns_of_rows()[i];
      squares[c] += residuals[at(i)] * residuals[at(i)];
      const bool has_next =
          i + 1 < windows.first_row(w + 1) && windows.columns_of_rows()[i + 1] == c;
      if (has_next) products[c] += residuals[at(i)] * residuals[at(i + 1)];
    }
  }
  for (std::size_t c = 0; c < columns; ++c) products[c] /= std::max(squares[c], 1e-300);
  return products;
}

// How much the numbers of a column vary: below 1e-9 of it, differences are rounding.
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
        windows_(task, std::move(windows)),
        spreads_(spreads_of(task)),
        u_(VectorXd::Zero(at(task.keys.size()))) {}

  // False if it is interrupted.
  bool run() {
    windows_.set_noise(spreads_);
    VectorXd residuals = windows_.residuals(u_, true);
    if (is_stopped()) return false;
    before_ = rms_of(windows_, residuals);
    refuse_idle_keys();
    set_noise(residuals);
    constexpr int most_rounds = 12;
    for (int round = 0; round < most_rounds; ++round) {
      if (!minimize()) return false;
      residuals = windows_.residuals(u_);
      const double change = set_noise(residuals);
      if (change < 1e-5) break;
    }
    residuals_ = windows_.residuals(u_);
    return !is_stopped();
  }

  // What the run has found.
  void tell() {
    const std::vector<double> rms = rms_of(windows_, residuals_);
    const std::vector<double> correlations = correlations_of(windows_, residuals_);
    const Squares squares = squares_of(windows_, residuals_);
    for (std::size_t c = 0; c < task_.columns.size(); ++c) {
      made_.columns.push_back({std::string(task_.columns[c]->name),
                               std::string(task_.columns[c]->unit),
                               before_[c],
                               rms[c],
                               {},
                               correlations[c]});
      // The starts take correlation away, so that white residuals rarely come to this.
      made_.white = made_.white && (rms[c] <= 1e-6 * spreads_[c] ||
                                    correlations[c] < 3 / std::sqrt(squares.count[c]));
    }
    tell_parameters();
  }

  // Of windows that are out of the fit, at its values.
  void tell_held(std::vector<Window> held) {
    if (held.empty()) return;
    WindowsFit others(task_, std::move(held));
    others.set_noise(windows_.noise());
    const std::vector<double> rms = rms_of(others, others.residuals(u_, false));
    for (std::size_t c = 0; c < rms.size(); ++c) made_.columns[c].held = rms[c];
  }

  [[nodiscard]] std::size_t size() const { return windows_.size(); }

 private:
  [[nodiscard]] bool is_stopped() const {
    return task_.stop != nullptr && task_.stop->load(std::memory_order_relaxed);
  }

  void refuse_idle_keys() {
    const VectorXd norms = windows_.derivatives(u_).free_norms;
    // With the noise at the columns' spreads, this is a change of the logs of one part in 1e7.
    const double least = 1e-7 * std::sqrt(static_cast<double>(windows_.size()));
    for (Index k = 0; k < norms.size(); ++k) {
      if (norms[k] > least) continue;
      std::string columns;
      for (const scenario::Column* const column : task_.columns) {
        columns += (columns.empty() ? "" : ", ") + std::string(column->name);
      }
      throw InputError("--free: " + task_.keys[static_cast<std::size_t>(k)].name +
                       ": has no effect on " + columns +
                       "; allowed: keys that the compared columns depend on");
    }
  }

  [[nodiscard]] double degrees_of_freedom() const {
    return std::max(1.0, static_cast<double>(windows_.size()) -
                             static_cast<double>(windows_.starts() + task_.keys.size()));
  }

  // Estimates each column's noise from its residuals. Returns how much the columns' weights change
  // against each other.
  double set_noise(const VectorXd& residuals) {
    const Squares squares = squares_of(windows_, residuals);
    const double share = degrees_of_freedom() / static_cast<double>(windows_.size());
    std::vector<double> noise;
    double least = unlimited, most = 0;
    for (std::size_t c = 0; c < spreads_.size(); ++c) {
      const double variance =
          squares.count[c] > 0 ? squares.sum[c] / (squares.count[c] * share) : 0;
      noise.push_back(std::max(std::sqrt(variance), 1e-9 * spreads_[c]));
      const double change = noise[c] / windows_.noise()[c];
      least = std::min(least, change);
      most = std::max(most, change);
    }
    windows_.set_noise(std::move(noise));
    return most / least - 1;
  }

  // Keys that come to a bound stay there, and the others go on.
  bool minimize() {
    std::vector<Index> moving;
    for (Index k = 0; k < u_.size(); ++k) moving.push_back(k);
    while (!moving.empty()) {
      Functor functor(task_, windows_, u_, moving, made_.iterations);
      Eigen::LevenbergMarquardt<Functor> method(functor);
      method.setFtol(1e-12);
      method.setXtol(1e-9);
      method.setFactor(1000);
      method.setMaxfev(200);
      VectorXd v(at(moving.size()));
      for (std::size_t i = 0; i < moving.size(); ++i) v[at(i)] = u_[moving[i]];
      method.minimize(v);
      if (is_stopped()) return false;
      u_ = functor.whole(v);
      std::vector<Index> rest;
      for (const Index k : moving) {
        const FreeKey& key = task_.keys[static_cast<std::size_t>(k)];
        const double value = key.value(u_[k]);
        const bool positive = key.logarithmic && key.lower == 0;
        const bool at_bound = (value == key.lower && !positive) || value == key.upper;
        if (at_bound) {
          u_[k] = key.number(value);
        } else {
          rest.push_back(k);
        }
      }
      if (rest.size() == moving.size()) return true;
      moving = std::move(rest);
    }
    return true;
  }

  void tell_parameters() {
    const auto [jacobian, norms] = windows_.derivatives(u_);
    const VectorXd sizes = norms.cwiseMax(1e-300);
    const MatrixXd scaled = jacobian * sizes.cwiseInverse().asDiagonal();
    const Eigen::JacobiSVD<MatrixXd> svd(scaled.transpose() * scaled, Eigen::ComputeFullV);
    // Of the square: singular values 1e-4 of the greatest are the error of the differences.
    const VectorXd values = svd.singularValues();
    const double least = 1e-8 * std::max(values[0], 1e-300);
    const Index keys = u_.size();
    VectorXd variances = VectorXd::Zero(keys);
    std::vector<char> told(static_cast<std::size_t>(keys), 1);
    for (Index j = 0; j < keys; ++j) {
      const VectorXd direction = svd.matrixV().col(j);
      if (values[j] > least) {
        variances += direction.cwiseAbs2() / values[j];
        continue;
      }
      for (Index k = 0; k < keys; ++k) {
        if (std::abs(direction[k]) > 0.02) told[static_cast<std::size_t>(k)] = 0;
      }
      made_.untold.push_back(words_for(direction.cwiseQuotient(sizes), direction));
    }
    const double scatter = residuals_.squaredNorm() / degrees_of_freedom();
    const double t = student_95(degrees_of_freedom());
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
        const double sd = std::sqrt(variances[k] * scatter) / sizes[k];
        one.sd = sd * std::abs(key.slope(u_[k]));
        one.low = key.value(u_[k] - t * sd);
        one.high = key.value(u_[k] + t * sd);
      } else {
        one.sd = one.high = unlimited;
        one.low = -unlimited;
      }
      made_.parameters.push_back(one);
    }
  }

  // "a and b are not told apart: a change of a by +1 % is undone by b by -1 %"
  [[nodiscard]] std::string words_for(const VectorXd& change, const VectorXd& weight) const {
    std::vector<Index> members;
    for (Index k = 0; k < change.size(); ++k) {
      if (std::abs(weight[k]) > 0.02) members.push_back(k);
    }
    if (members.size() == 1) {
      return task_.keys[static_cast<std::size_t>(members[0])].name +
             " is not told by the log: what it changes, another start of each window changes, too";
    }
    std::string names, changes;
    // So that the first key changes by 1 %, or by a hundredth of its scale.
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
    return names + " are not told apart by the log: it stays the same with " + changes;
  }

  const Task& task_;
  Fitted& made_;
  WindowsFit windows_;
  std::vector<double> spreads_, before_;
  VectorXd u_, residuals_;
};

// Tables of the scenario end where their splines would run away.
void require_tables(const Task& task, const std::vector<Window>& windows) {
  std::vector<Span> spans;
  for (const Log& log : task.logs) {
    spans.push_back(span_of_tables(task.family.read(log.settings)));
  }
  for (const Window& window : windows) {
    const Log& log = task.logs[window.log];
    const Span& span = spans[window.log];
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
  // A loop keeps errors small, and states that no log tells go on in it.
  const bool whole_logs = scenario.controller && !task.window && task.hold_out == 0;
  made.window = whole_logs ? unlimited : task.window.value_or(usual_window);
  const std::size_t coordinates =
      start_coordinates(task.columns, !scenario.gimbal.motion && !whole_logs).size();
  std::vector<Window> windows, held;
  double longest = 0;
  for (const Log& log : task.logs) {
    if (!log.times.empty()) longest = std::max(longest, log.times.back() - log.times.front());
  }
  for (Window& window :
       cut(task.logs, std::min(made.window, 2 * longest + 1), task.hold_out, coordinates)) {
    (window.held ? held : windows).push_back(std::move(window));
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
    throw InputError("the logs have " + std::to_string(numbers) + " numbers in " +
                     std::to_string(windows.size()) + " windows; allowed: more than the " +
                     std::to_string(unknowns) +
                     " that are sought, starts included; a longer --window or fewer --free keys");
  }
  require_tables(task, windows);
  require_tables(task, held);
  Fit fit(task, std::move(windows), made);
  if (!fit.run()) {
    made.interrupted = true;
    return made;
  }
  fit.tell();
  fit.tell_held(std::move(held));
  return made;
}

}  // namespace bbsim::fit
