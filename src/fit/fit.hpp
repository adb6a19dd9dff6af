// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Finds the values of keys at which runs of a scenario are closest to logs of a rig.
//
// Least squares over windows of the logs. Each window has a start of its own, which a linear
// problem inside eliminates (variable projection); Levenberg and Marquardt's method finds the keys.
// With continuity, windows that follow one another then become one trajectory (chain.hpp).
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

// The length of windows if nothing else is said, s: a plate makes the ball a double integrator.
inline constexpr double usual_window = 2;

struct Task {
  const ScenarioFamily& family;
  std::vector<FreeKey> keys;
  std::vector<const scenario::Column*> columns;  // that are compared
  std::vector<Log> logs;
  std::optional<double> window{};  // s; without one, what suits the scene
  double hold_out = 0;             // the share of windows that are out of the fit
  std::size_t threads = 0;         // 0: as many as there are processors
  std::size_t starts = 1;          // sets of values to begin with; the best goes on
  bool robust = false;             // Huber's loss in place of least squares
  bool continuity = false;         // windows without a gap between them join in the end
  std::function<void(double fraction, const std::string& detail)> progress{};
  const std::atomic<bool>* stop = nullptr;
  bool with_series = false;                // Fitted has them
  std::vector<FreeKey> candidates{};       // that may be lacking if residuals are not white
  std::function<void(Scenario&)> adapt{};  // changes each scenario that is read
};

struct Parameter {
  std::string key, unit;
  double start = 0, estimate = 0;
  // Of a key that the logs do not tell: infinite.
  double sd = 0;
  double low = 0, high = 0;  // the 95 % interval, by profile likelihood
  bool told = true;
  bool at_bound = false;
};

struct ColumnResidual {
  std::string column, unit;
  double before = 0, rms = 0;  // of the windows of the fit, with the scenario's values and after
  std::optional<double> held_before{},
      held{};  // of the windows that were held out, likewise; none if one does not run
  std::optional<double> ideal{},
      held_ideal{};        // of an ideal rig (ideal_rig.hpp), where there is one
  double correlation = 0;  // of neighboring residuals
  // Numbers that are beyond five standard deviations, and where the first one is.
  std::size_t outliers = 0;
  std::string outlier_log{};
  double outlier_time = 0;  // s
};

// A window at the values that were found, with its fitted start.
struct WindowSeries {
  std::size_t log = 0;
  double begin = 0;  // s
  bool held = false;
  std::vector<double> times;  // s, by the scenario's clock
  // Of each compared column: the log's numbers, NaN where a row lacks one, and the model's, NaN if
  // the scene does not run to the window's end.
  std::vector<std::vector<double>> measured, modelled;
};

// A key that is not free, and the share of the residuals' root mean square that it could take away.
struct Suggestion {
  std::string key;
  double share = 0;
};

struct Fitted {
  // Stopped on the way: what follows is the best so far, if there are parameters.
  bool interrupted = false;
  std::vector<Parameter> parameters;
  std::vector<ColumnResidual> columns;
  // Keys that the logs tell only together: "a of +1 % is undone by b of -1 %".
  std::vector<std::string> untold;
  std::size_t windows = 0, held = 0, numbers = 0;
  std::optional<std::size_t> joints{};  // with continuity
  std::vector<WindowSeries> series;     // those that were held out last; only if they are asked for
  double window = 0;                    // s
  bool white = true;                    // neighboring residuals are independent
  std::optional<Suggestion> suggestion{};  // only if they are not
  std::size_t iterations = 0;
  // Of each pair of parameters; NaN for those that the logs do not tell.
  std::vector<std::vector<double>> correlations;
};

// Throws InputError: for logs with too little in them, for keys that change nothing, and where the
// scene does not run over a window with the values that the fit begins with.
[[nodiscard]] Fitted fit(const Task& task);

}  // namespace bbsim::fit
