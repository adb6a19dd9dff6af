// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "fit/played_servos.hpp"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "fit/clock_shift.hpp"
#include "fit/window_run.hpp"
#include "model/signals/reference_path.hpp"
#include "scenario/columns.hpp"

namespace bbsim::fit {

Scenario window_of(const Scenario& whole, double begin, double end) {
  constexpr double lead = 1;  // s; servos forget their past in less
  Scenario window = from_time(whole, begin, end);
  if (commands_of(whole) == nullptr) return window;
  const double before = std::min(begin, lead);
  Scenario run_up = from_time(whole, begin - before, begin);
  GimbalStart& start = run_up.gimbal.start;
  // A run-up from 0 starts like the scenario.
  if (begin > before) {
    const auto commands = model::reference_path(run_up.controller->reference, 0).at(0.0);
    start = {commands[0].value, commands[1].value, 0, 0};
  }
  window.gimbal.start = start;
  if (!(before > 0)) return window;
  std::vector<const scenario::Column*> columns;
  for (const std::string_view name : {"phi", "theta", "phi_rate", "theta_rate"}) {
    columns.push_back(scenario::find_column(name));
  }
  std::string unheard;
  const std::vector<double> at = run_window(run_up, {}, {before}, columns, unheard);
  if (at.empty()) return window;
  const Mounting& mounting = whole.gimbal.mounting;
  window.gimbal.start = {at[0] - mounting.phi_offset, at[1] - mounting.theta_offset, at[2], at[3]};
  return window;
}

}  // namespace bbsim::fit
