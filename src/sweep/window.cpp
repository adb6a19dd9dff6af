// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sweep/window.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/number_text.hpp"
#include "model/model.hpp"
#include "model/signals/signal_pair.hpp"
#include "solve/integrate.hpp"
#include "sweep/clock_shift.hpp"

namespace bbsim::sweep {
namespace {

// Splines would run away beyond the scenario's tables.
void require_tables(const Scenario& whole, double begin, double end) {
  const Span span = span_of_tables(whole);
  const double slack = 1e-6 * std::max(1.0, std::abs(end));
  if (begin >= span.from - slack && end <= span.to + slack) return;
  throw InputError("found a case from " + short_number(begin) + " to " + short_number(end) +
                   " s; allowed: times that the scenario's tables cover, " +
                   short_number(span.from) + " to " + short_number(span.to) + " s");
}

}  // namespace

void set_start(Scenario& scenario, const Start& start) {
  scenario.ball.position = {start[0], start[1]};
  scenario.ball.velocity = {start[2], start[3]};
  scenario.ball.spin = start[8];
  if (begins_anywhere(scenario)) {
    scenario.gimbal.start = {start[4], start[5], start[6], start[7]};
  }
}

bool begins_anywhere(const Scenario& scenario) {
  return !scenario.gimbal.motion && commands_of(scenario) == nullptr;
}

void remove_events(Scenario& scenario) {
  Events& events = scenario.events;
  if (events.slip && !events.slip->sliding) events.slip.reset();
  events.edge.reset();
  events.lift_off.reset();
  events.tilt.reset();
  events.singularity.reset();
  events.rest.reset();
  events.stick.reset();
  events.steps_lost.reset();
}

Scenario window_of(const Scenario& whole, double begin, double end) {
  constexpr double lead = 1;  // s; servos forget their past in less
  require_tables(whole, begin, end);
  Scenario window = from_time(whole, begin, end);
  window.time.step = std::min(whole.time.step, end - begin);
  if (commands_of(whole) == nullptr) return window;
  const double before = std::clamp(begin, 0.0, lead);
  Scenario run_up = from_time(whole, begin - before, begin);
  GimbalStart& start = run_up.gimbal.start;
  // A run-up from 0 starts like the scenario.
  if (begin > before) {
    const auto commands = model::reference_path(run_up.controller->reference, 0).at(0.0);
    start = {commands[0].value, commands[1].value, 0, 0};
  }
  window.gimbal.start = start;
  if (!(before > 0)) return window;
  set_start(run_up, {});
  try {
    const model::Model model = model::assemble(run_up, false);
    const solve::OutputGrid grid(run_up.time);
    solve::Trajectory rows(model.row_size());
    const Solver& solver = run_up.solver;
    if (solve::integrate(model, solver.method, {solver.rtol, solver.atol}, grid, rows).ending !=
        solve::Ending::done) {
      return window;
    }
    const auto at =
        model.sample(grid.end(), rows.row(rows.rows() - 1), model::Detail::gimbal).gimbal;
    const Mounting& mounting = whole.gimbal.mounting;
    window.gimbal.start = {at.phi - mounting.phi_offset, at.theta - mounting.theta_offset,
                           at.phi_dot, at.theta_dot};
  } catch (const InputError&) {  // the window's own run reports it
  }
  return window;
}

}  // namespace bbsim::sweep
