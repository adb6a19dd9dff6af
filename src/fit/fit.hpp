// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Finds the values of keys at which runs of a scenario are closest to logs of a rig.
//
// Least squares over windows of the logs. Each window has its own start, which an inner linear
// problem eliminates (variable projection); the Levenberg-Marquardt method finds the keys. With
// continuity, consecutive windows then become one trajectory (chain.hpp).
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "fit/data.hpp"
#include "fit/free_key.hpp"

namespace bbsim::fit {

// Default length of windows, s; short, because a plate makes the ball a double integrator.
inline constexpr double usual_window = 2;

struct Task {
  const ScenarioFamily& family;
  std::vector<FreeKey> keys;
  std::vector<const scenario::Column*> columns;  // compared columns
  std::vector<Log> logs;
  std::optional<double> window{};  // s; by default, what suits the scene
  double hold_out = 0;             // share of windows left out of the fit
  std::size_t threads = 0;         // 0: one per processor
  std::size_t starts = 1;          // number of sets of initial values; the best continues
  bool robust = false;             // Huber's loss instead of least squares
  bool continuity = false;         // in the end joins windows that have no gap between them
  std::function<void(double fraction, const std::string& detail)> progress{};
  const std::atomic<bool>* stop = nullptr;
  bool with_series = false;                // fills Fitted::series
  std::vector<FreeKey> candidates{};       // suggested if residuals are not white
  std::function<void(Scenario&)> adapt{};  // changes each scenario after reading
};

struct Parameter {
  std::string key, unit;
  double start = 0, estimate = 0;
  // Infinite for a key that the logs do not determine.
  double sd = 0;
  double low = 0, high = 0;  // 95 % interval by profile likelihood
  bool told = true;
  bool at_bound = false;
};

struct ColumnResidual {
  std::string column, unit;
  double before = 0, rms = 0;  // in the fit's windows, with the scenario's and the fitted values
  std::optional<double> held_before{},
      held{};  // the same for held-out windows; empty if one does not run
  std::optional<double> ideal{},
      held_ideal{};        // of an ideal rig (ideal_rig.hpp); empty if there is none
  double correlation = 0;  // between neighboring residuals
  // Count of numbers beyond five standard deviations, and where the first one is.
  std::size_t outliers = 0;
  std::string outlier_log{};
  double outlier_time = 0;  // s
};

// A window at the fitted values, with its fitted start.
struct WindowSeries {
  std::size_t log = 0;
  double begin = 0;  // s
  bool held = false;
  std::vector<double> times;  // s, by the scenario's clock
  // Per compared column: the log's numbers, NaN where a row has none, and the model's, NaN if the
  // scene does not run to the window's end.
  std::vector<std::vector<double>> measured, modelled;
};

// A key that is not free, and the share of the residuals' root mean square that it could remove.
struct Suggestion {
  std::string key;
  double share = 0;
};

struct Fitted {
  // Stopped early: the rest is the best so far, if there are parameters.
  bool interrupted = false;
  std::vector<Parameter> parameters;
  std::vector<ColumnResidual> columns;
  // Sentences on keys that the logs do not determine, alone or together.
  std::vector<std::string> untold;
  std::size_t windows = 0, held = 0, numbers = 0;
  std::optional<std::size_t> joints{};     // with continuity
  std::vector<WindowSeries> series;        // held-out ones last; only if requested
  double window = 0;                       // s
  bool white = true;                       // neighboring residuals are independent
  std::optional<Suggestion> suggestion{};  // only if white is false
  std::size_t iterations = 0;
  // Per pair of parameters; NaN for those that the logs do not determine.
  std::vector<std::vector<double>> correlations;
};

// Throws InputError if the logs have too few numbers, if a key has no effect, or if the scene does
// not run over a window with the initial values.
[[nodiscard]] Fitted fit(const Task& task);

}  // namespace bbsim::fit
