// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Finds the values of keys at which runs of a scenario are closest to logs of a rig.
//
// Least squares over windows of the logs. Each window has a start of its own, which a linear
// problem inside eliminates (variable projection); Levenberg and Marquardt's method finds the keys.
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
  std::function<void(double fraction, const std::string& detail)> progress{};
  const std::atomic<bool>* stop = nullptr;
  std::function<void(Scenario&)> adapt{};  // changes each scenario that is read
};

struct Parameter {
  std::string key, unit;
  double start = 0, estimate = 0;
  // Of a key that the logs do not tell: infinite.
  double sd = 0, low = 0, high = 0;
  bool told = true;
  bool at_bound = false;
};

struct ColumnResidual {
  std::string column, unit;
  double before = 0, rms = 0;    // of the windows of the fit, with the scenario's values and after
  std::optional<double> held{};  // of the windows that were held out
  double correlation = 0;        // of neighboring residuals
};

struct Fitted {
  bool interrupted = false;
  std::vector<Parameter> parameters;
  std::vector<ColumnResidual> columns;
  // Keys that the logs tell only together: "a of +1 % is undone by b of -1 %".
  std::vector<std::string> untold;
  std::size_t windows = 0, held = 0, numbers = 0;
  double window = 0;  // s
  bool white = true;  // neighboring residuals are independent
  std::size_t iterations = 0;
};

// Throws InputError: for logs with too little in them, for keys that change nothing, and where the
// scene does not run over a window with the values that the fit begins with.
[[nodiscard]] Fitted fit(const Task& task);

}  // namespace bbsim::fit
