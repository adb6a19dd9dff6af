// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "fit/windows_fit.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <mutex>
#include <string_view>
#include <thread>
#include <utility>

#include "base/error.hpp"
#include "base/short_number.hpp"

namespace bbsim::fit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Central difference steps of u and of a start (m, m/s, rad, rad/s): both the run's error over the
// step and the step's square are small.
constexpr double key_step = 1e-3, start_step = 1e-3;

// Directions of a start with less effect than this part stay fixed.
constexpr double start_threshold = 1e-9;

const scenario::Column* column_of_state(std::size_t state) {
  constexpr std::string_view names[] = {"x",     "y",        "vx",         "vy",  "phi",
                                        "theta", "phi_rate", "theta_rate", "spin"};
  return scenario::find_column(names[state]);
}

}  // namespace

WindowsFit::WindowsFit(const Task& task, std::vector<Window> windows)
    : task_(task), windows_(std::move(windows)) {
  bool from_within = false;
  for (const Window& window : windows_) from_within = from_within || !window.first;
  const std::vector<Scenario> scenes =
      variant(VectorXd::Zero(at(task.keys.size())), nullptr).scenes;
  coordinates_ = start_coordinates(task.columns, from_within && begins_anywhere(scenes.front()));
  for (const Window& window : windows_) {
    first_rows_.push_back(size_);
    for (std::size_t c = 0; c < window.values.size(); ++c) {
      for (const double value : window.values[c]) {
        if (!std::isfinite(value)) continue;
        columns_.push_back(c);
        ++size_;
      }
    }
  }
  first_rows_.push_back(size_);
  weights_ = VectorXd::Ones(at(size_));
  base_.resize(windows_.size());
  for (State& state : base_) state.start = start_of(scenes.front());
  guess_starts();
}

// Guesses each window's start: its first measurement, at rest.
void WindowsFit::guess_starts() {
  for (std::size_t w = 0; w < windows_.size(); ++w) {
    constexpr std::string_view names[] = {"x", "y", "", "", "phi", "theta", "", ""};
    for (std::size_t i = 0; i < base_[w].start.size(); ++i) {
      if (std::ranges::find(coordinates_, i) == coordinates_.end()) continue;
      if (i == 2 || i == 3) base_[w].start[i] = 0;
      for (std::size_t c = 0; c < task_.columns.size(); ++c) {
        if (task_.columns[c]->name != names[i]) continue;
        const auto& values = windows_[w].values[c];
        const auto first =
            std::ranges::find_if(values, [](double value) { return std::isfinite(value); });
        if (first != values.end()) base_[w].start[i] = *first;
      }
    }
  }
}

// Rescales the rows of known derivatives to new weights.
void WindowsFit::scale_rows(const VectorXd& factors) {
  for (std::size_t w = 0; w < windows_.size(); ++w) {
    State& state = base_[w];
    if (state.by_start.rows() == 0) continue;
    const auto rows = factors.segment(at(first_rows_[w]), state.by_start.rows()).asDiagonal();
    state.by_start = rows * state.by_start;
    state.start_solver = model::LeastSquares(state.by_start, start_threshold);
    if (state.by_key.rows() > 0) state.by_key = rows * state.by_key;
  }
  trial_u_.resize(0);
}

void WindowsFit::set_noise(std::vector<double> noise) {
  VectorXd factors = VectorXd::Ones(at(size_));
  for (std::size_t i = 0; i < size_ && !noise_.empty(); ++i) {
    factors[at(i)] = noise_[columns_[i]] / noise[columns_[i]];
  }
  noise_ = std::move(noise);
  scale_rows(factors);
}

void WindowsFit::set_weights(VectorXd weights) {
  const VectorXd factors = weights.cwiseQuotient(weights_);
  weights_ = std::move(weights);
  scale_rows(factors);
}

void WindowsFit::restart() {
  guess_starts();
  for (State& state : base_) state.fresh_rounds = State{}.fresh_rounds;
  base_u_.resize(0);
  trial_u_.resize(0);
}

bool WindowsFit::is_stopped() const {
  return heeds_stop_ && task_.stop != nullptr && task_.stop->load(std::memory_order_relaxed);
}

Variant WindowsFit::variant(const VectorXd& u, std::string* why) const {
  Variant made;
  std::vector<Scenario>& scenes = made.scenes;
  Sensors& sensors = made.sensors;
  sensors.scales.assign(task_.columns.size(), 1);
  sensors.offsets.assign(task_.columns.size(), 0);
  for (std::size_t k = 0; k < task_.keys.size(); ++k) {
    const FreeKey& key = task_.keys[k];
    const double value = key.value(u[at(k)]);
    if (key.of == FreeKey::Of::scale) sensors.scales[key.column] = value;
    if (key.of == FreeKey::Of::offset) sensors.offsets[key.column] = value;
    if (key.of == FreeKey::Of::delay) sensors.delay = value;
  }
  try {
    for (const Log& log : task_.logs) {
      // Logs without their own settings share the scenario.
      if (!scenes.empty() && log.settings.empty()) {
        scenes.push_back(scenes.front());
        continue;
      }
      std::vector<ScenarioFamily::Setting> settings = log.settings;
      for (std::size_t k = 0; k < task_.keys.size(); ++k) {
        const FreeKey& key = task_.keys[k];
        if (key.of == FreeKey::Of::scenario) {
          settings.push_back(key.setting(key.value(u[at(k)])));
        }
      }
      Scenario scenario = task_.family.read(settings);
      if (task_.adapt) task_.adapt(scenario);
      scenes.push_back(prepared(std::move(scenario)));
    }
  } catch (const InputError& error) {
    if (why == nullptr) throw;
    *why = error.what();
    scenes.clear();
  }
  return made;
}

WindowsFit::Scene WindowsFit::scene_of(std::size_t w, const Variant& variant) const {
  const Window& window = windows_[w];
  const double end = has_joint(w) ? windows_[w + 1].begin : window.begin + window.times.back();
  return {sweep::window_of(variant.scenes[window.log], window.begin, end), variant.sensors};
}

void WindowsFit::for_each_window(const std::function<void(std::size_t)>& work) const {
  std::size_t threads = task_.threads;
  if (threads == 0) threads = std::max(1U, std::thread::hardware_concurrency());
  threads = std::min(threads, windows_.size());
  std::atomic<std::size_t> next = 0;
  std::exception_ptr thrown;
  std::mutex mutex;
  const auto some = [&] {
    try {
      for (std::size_t w = next++; w < windows_.size(); w = next++) {
        if (is_stopped()) return;
        work(w);
      }
    } catch (...) {
      const std::lock_guard lock(mutex);
      thrown = std::current_exception();
      next = windows_.size();
    }
  };
  {
    std::vector<std::jthread> others;
    for (std::size_t i = 1; i < threads; ++i) others.emplace_back(some);
    some();
  }
  if (thrown) std::rethrow_exception(thrown);
}

bool WindowsFit::residual_of(std::size_t w, const Scene& scene, const Start& start, VectorXd& into,
                             std::string& why, Start* end) const {
  const Window& window = windows_[w];
  const Sensors& sensors = scene.sensors;
  std::vector<double> shown = window.times;  // the times that the sensors show
  for (double& time : shown) time = std::max(time - sensors.delay, 0.0);
  std::vector<const scenario::Column*> columns = task_.columns;
  const bool joins = end != nullptr && has_joint(w);
  if (joins) {
    shown.push_back(windows_[w + 1].begin - window.begin);
    for (const std::size_t state : states_) columns.push_back(column_of_state(state));
  }
  const std::vector<double> values = run_window(scene.scenario, start, shown, columns, why);
  into.resize(at(first_rows_[w + 1] - first_rows_[w]));
  if (values.empty()) return false;
  Index row = 0;
  const std::size_t rows = window.times.size();
  for (std::size_t c = 0; c < window.values.size(); ++c) {
    for (std::size_t i = 0; i < rows; ++i) {
      const double measured = window.values[c][i];
      if (!std::isfinite(measured)) continue;
      const double modelled = values[c * shown.size() + i];
      const double expected = sensors.offsets[c] + sensors.scales[c] * modelled;
      into[row++] = (expected - measured) / noise_[c];
    }
  }
  into.array() *= weights_.segment(at(first_rows_[w]), into.size()).array();
  if (!joins) return true;
  *end = start;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    (*end)[states_[i]] = values[(task_.columns.size() + i + 1) * shown.size() - 1];
  }
  if (begins_anywhere(scene.scenario)) {  // gimbal.start excludes the mounting's errors
    (*end)[4] -= scene.scenario.gimbal.mounting.phi_offset;
    (*end)[5] -= scene.scenario.gimbal.mounting.theta_offset;
  }
  return true;
}

bool WindowsFit::slopes(std::size_t w, const Scene& scene, State& state) const {
  const std::vector<std::size_t>& coordinates = joined_ ? states_ : coordinates_;
  std::string why;
  MatrixXd by_start(at(first_rows_[w + 1] - first_rows_[w]), at(coordinates.size()));
  MatrixXd end_by_start(at(states_.size()), at(coordinates.size()));
  VectorXd up, down;
  for (std::size_t k = 0; k < coordinates.size(); ++k) {
    Start moved = state.start, end_up{}, end_down{};
    moved[coordinates[k]] += start_step;
    if (!residual_of(w, scene, moved, up, why, &end_up)) return false;
    moved[coordinates[k]] -= 2 * start_step;
    if (!residual_of(w, scene, moved, down, why, &end_down)) return false;
    by_start.col(at(k)) = (up - down) / (2 * start_step);
    end_by_start.col(at(k)) = (states_of(end_up) - states_of(end_down)) / (2 * start_step);
  }
  state.by_start = std::move(by_start);
  state.end_by_start = std::move(end_by_start);
  state.start_solver = model::LeastSquares(state.by_start, start_threshold);
  return true;
}

// Newton's method for the best start with the known slopes: the motion depends on its start almost
// linearly.
bool WindowsFit::settle(std::size_t w, const Scene& scene, State& state, std::string& why) const {
  if (!residual_of(w, scene, state.start, state.residual, why)) return false;
  const int fresh = std::exchange(state.fresh_rounds, 0);
  constexpr int most_rounds = 12;
  for (int round = 0; round < most_rounds; ++round) {
    if (round < fresh) {
      if (!slopes(w, scene, state)) {
        why = "it does not run from starts nearby";
        return false;
      }
    }
    const VectorXd step = state.start_solver.solve(state.residual);
    // The step's gain is known before its run.
    const double left = (state.by_start * step).squaredNorm();
    if (round >= fresh && left <= 1e-14 * state.residual.squaredNorm()) break;
    Start moved = state.start;
    for (std::size_t k = 0; k < coordinates_.size(); ++k) {
      moved[coordinates_[k]] -= step[at(k)];
    }
    VectorXd residual;
    std::string unheard;
    if (!residual_of(w, scene, moved, residual, unheard)) break;
    const double before = state.residual.squaredNorm(), after = residual.squaredNorm();
    if (!(after <= before * (1 + 1e-12))) break;
    state.start = moved;
    state.residual = residual;
    if (before - after <= 1e-12 * before && round + 1 >= fresh) break;
  }
  return true;
}

VectorXd WindowsFit::residuals(const VectorXd& u, bool first) {
  VectorXd all = VectorXd::Constant(at(size_), far);
  std::string why;
  const Variant scenes = variant(u, first ? nullptr : &why);
  if (scenes.scenes.empty()) return all;
  trial_ = base_;
  trial_u_.resize(0);
  const VectorXd change = base_u_.size() == u.size() ? VectorXd(u - base_u_) : VectorXd{};
  std::vector<std::string> faults(windows_.size());
  std::vector<char> runs(windows_.size(), 0);
  if (joined_) {
    if (change.size() > 0) {
      for (const Chain& chain : chains_) predict(chain, change);
    }
    close_chains(scenes, runs, faults);
  }
  for_each_window([&](std::size_t w) {
    if (joined_) return;
    const Scene scene = scene_of(w, scenes);
    // The best start follows the keys almost linearly.
    if (change.size() > 0 && !change.isZero(0) && base_[w].by_key.rows() > 0) {
      const VectorXd step = base_[w].start_solver.solve(VectorXd(base_[w].by_key * change));
      for (std::size_t k = 0; k < coordinates_.size(); ++k) {
        trial_[w].start[coordinates_[k]] -= step[at(k)];
      }
      if (settle(w, scene, trial_[w], faults[w])) {
        runs[w] = 1;
        return;
      }
      trial_[w] = base_[w];
    }
    runs[w] = settle(w, scene, trial_[w], faults[w]) ? 1 : 0;
  });
  if (is_stopped()) return all;
  for (std::size_t w = 0; w < windows_.size(); ++w) {
    if (runs[w] != 0) {
      all.segment(at(first_rows_[w]), trial_[w].residual.size()) = trial_[w].residual;
    } else if (first) {
      throw InputError(task_.logs[windows_[w].log].name +
                       ": from t = " + short_number(windows_[w].begin) +
                       " s on, the scenario does not run to the "
                       "window's end: " +
                       faults[w]);
    }
  }
  trial_u_ = u;
  return all;
}

WindowsFit::Derivatives WindowsFit::derivatives(const VectorXd& u) {
  if (trial_u_.size() != u.size() || trial_u_ != u) static_cast<void>(residuals(u));
  base_ = trial_;
  return differences(u);
}

WindowsFit::Derivatives WindowsFit::derivatives(const VectorXd& u,
                                                const std::vector<Start>& starts) {
  for (std::size_t w = 0; w < base_.size(); ++w) base_[w].start = starts[w];
  return differences(u);
}

// Derivatives at the starts of `base_`.
WindowsFit::Derivatives WindowsFit::differences(const VectorXd& u) {
  const Index keys = u.size();
  std::string why;
  const Variant middle = variant(u, &why);
  std::vector<Variant> up, down;
  std::vector<double> width;
  for (Index k = 0; k < keys; ++k) {
    const FreeKey& key = task_.keys[static_cast<std::size_t>(k)];
    const auto moved = [&](double step) {
      VectorXd to = u;
      to[k] += step;
      return to;
    };
    up.push_back(variant(moved(key_step), &why));
    down.push_back(variant(moved(-key_step), &why));
    double from = -key_step, to = key_step;
    // A value at its bound has a neighbor on one side only.
    if (up.back().scenes.empty() || key.value(u[k] + key_step) == key.value(u[k])) {
      up.back() = middle;
      to = 0;
    } else if (down.back().scenes.empty() || key.value(u[k] - key_step) == key.value(u[k])) {
      down.back() = middle;
      from = 0;
    }
    width.push_back(down.back().scenes.empty() ? 0 : to - from);
  }
  for_each_window([&](std::size_t w) {
    State& state = base_[w];
    std::string unheard;
    state.by_key = MatrixXd::Zero(at(first_rows_[w + 1] - first_rows_[w]), keys);
    state.end_by_key = MatrixXd::Zero(at(states_.size()), keys);
    if (!slopes(w, scene_of(w, middle), state)) return;
    state.fresh_rounds = 0;
    Start end_above{}, end_below{};
    VectorXd above, below;
    for (Index k = 0; k < keys; ++k) {
      const auto i = static_cast<std::size_t>(k);
      if (width[i] == 0) continue;
      if (!residual_of(w, scene_of(w, up[i]), state.start, above, unheard, &end_above)) continue;
      if (!residual_of(w, scene_of(w, down[i]), state.start, below, unheard, &end_below)) continue;
      state.by_key.col(k) = (above - below) / width[i];
      state.end_by_key.col(k) = (states_of(end_above) - states_of(end_below)) / width[i];
    }
  });
  base_u_ = u;
  return projected(keys);
}

// The starts follow the keys: what they undo is no effect of a key.
WindowsFit::Derivatives WindowsFit::projected(Index keys) const {
  Derivatives made{MatrixXd::Zero(at(size_), keys), VectorXd::Zero(keys)};
  VectorXd squares = VectorXd::Zero(keys);
  for (const Chain& chain : chains_) {
    if (!has_derivatives(chain, keys)) continue;
    const Condensed linear = condensed(chain, base_, keys);
    squares += linear.by_key.colwise().squaredNorm().transpose();
    made.projected.middleRows(at(first_rows_[chain.first]), linear.by_key.rows()) =
        linear.by_key + linear.by_first * linear.best_first_by_key();
  }
  for (std::size_t w = 0; w < windows_.size(); ++w) {
    const State& state = base_[w];
    if (joined_ || state.by_key.cols() != keys || state.by_start.rows() == 0) continue;
    squares += state.by_key.colwise().squaredNorm().transpose();
    made.projected.middleRows(at(first_rows_[w]), state.by_key.rows()) =
        state.by_key - state.by_start * state.start_solver.solve(state.by_key);
  }
  made.free_norms = squares.cwiseSqrt();
  return made;
}

std::vector<WindowSeries> WindowsFit::series(const VectorXd& u) {
  if (trial_u_.size() != u.size() || trial_u_ != u) static_cast<void>(residuals(u));
  // With logs of zeros the residuals are the model's values, also where a log has no number.
  std::vector<Window> zeros = windows_;
  for (Window& window : zeros) {
    for (std::vector<double>& column : window.values) std::ranges::fill(column, 0.0);
  }
  WindowsFit model(task_, std::move(zeros));
  model.set_noise(std::vector<double>(task_.columns.size(), 1.0));
  const Variant scenes = variant(u, nullptr);
  std::vector<WindowSeries> made;
  for (std::size_t w = 0; w < windows_.size(); ++w) {
    const Window& window = windows_[w];
    const std::size_t rows = window.times.size();
    WindowSeries one{window.log, window.begin, window.held, window.times, window.values, {}};
    for (double& time : one.times) time += window.begin;
    VectorXd values;
    std::string unheard;
    if (!model.residual_of(w, scene_of(w, scenes), trial_[w].start, values, unheard)) {
      values.setConstant(std::numeric_limits<double>::quiet_NaN());
    }
    for (std::size_t c = 0; c < window.values.size(); ++c) {
      const double* const first = values.data() + c * rows;
      one.modelled.emplace_back(first, first + rows);
    }
    made.push_back(std::move(one));
  }
  return made;
}

}  // namespace bbsim::fit
