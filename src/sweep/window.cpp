// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sweep/window.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <type_traits>

#include "base/error.hpp"
#include "base/number_text.hpp"
#include "model/model.hpp"
#include "model/signals/signal_pair.hpp"
#include "solve/integrate.hpp"

namespace bbsim::sweep {
namespace {

using Numbers = std::vector<double>;

// A row's effect on the spline decays by 0.27 per row: at this distance it is rounding.
constexpr std::ptrdiff_t margin = 40;

void shift_rows(Numbers& times, std::initializer_list<Numbers*> values, double begin, double end) {
  // A table that holds its end values has an extra row at either end, which stays.
  const std::ptrdiff_t outside = std::isinf(times.front()) ? 1 : 0;
  const auto first = std::ranges::lower_bound(times, begin) - times.begin();
  const auto last = std::ranges::upper_bound(times, end) - times.begin();
  const auto size = static_cast<std::ptrdiff_t>(times.size()) - outside;
  const auto from = std::clamp(first - margin, outside, size);
  const auto to = std::clamp(last + margin, from, size);
  const auto keep = [outside, from, to, size](Numbers& numbers) {
    numbers.erase(numbers.begin() + to, numbers.begin() + size);
    numbers.erase(numbers.begin() + outside, numbers.begin() + from);
  };
  keep(times);
  for (Numbers* const column : values) keep(*column);
  for (double& time : times) time -= begin;
}

struct Shift {
  double begin, end;

  void shift_term(double& /*constant*/) const {}
  void shift_term(Table& term) const { shift_rows(term.times, {&term.values}, begin, end); }
  template <class Term>
  void shift_term(Term& term) const {
    term.move_clock(begin);
  }

  void operator()(PointReference& /*point*/) const {}
  void operator()(CircleReference& circle) const { circle.phase += circle.rate * begin; }
  void operator()(LissajousReference& figure) const {
    for (std::size_t i = 0; i < 2; ++i) figure.phase[i] += figure.rate[i] * begin;
  }
  void operator()(WaypointReference& way) const {
    for (double& time : way.times) time -= begin;
  }
  void operator()(StaircaseReference& stairs) const {
    for (double& jump : stairs.jumps) jump -= begin;
  }
  void operator()(SquareReference& square) const {
    for (double& phase : square.phase) phase += 2 * std::numbers::pi / square.period * begin;
  }
  void operator()(TableReference& table) const {
    shift_rows(table.times, {&table.x, &table.y}, begin, end);
  }

  void operator()(CommandProfiles& commands) const {
    (*this)(commands.phi);
    (*this)(commands.theta);
  }
  void operator()(Profile& profile) const {
    for (ProfileTerm& term : profile) {
      std::visit([this](auto& part) { shift_term(part); }, term);
    }
  }
};

template <class AnyScenario, class Use>
void for_each_profile(AnyScenario& scenario, Use use) {
  for (auto* const pair : {&scenario.gimbal.motion, &scenario.gimbal.torque}) {
    if (!*pair) continue;
    use((*pair)->phi);
    use((*pair)->theta);
  }
  if (scenario.ball.push) {
    use(scenario.ball.push->x);
    use(scenario.ball.push->y);
  }
}

// Moves the clock so that t = 0 is `begin`, and ends the run at `end` (s, old clock). Motions,
// torques, pushes and the reference continue as they are then. Tables lose rows that are too far
// away to matter. A sampled controller starts sampling at t = 0; one that plays known commands
// keeps the clock of its samples and the commands under way.
Scenario from_time(const Scenario& scenario, double begin, double end) {
  Scenario moved = scenario;
  const Shift shift{begin, end};
  for_each_profile(moved, shift);
  if (moved.controller) std::visit(shift, moved.controller->reference);
  // Known commands need no measurement, so their samples continue from before.
  if (commands_of(moved) != nullptr && moved.controller->sampling) {
    moved.controller->sampling->since += begin;
  }
  moved.time.end = end - begin;
  moved.time.step = moved.time.end;
  return moved;
}

// Times that all tables of the scene cover, s; infinite without tables.
struct Span {
  double from, to;
};

Span span_of_tables(const Scenario& scenario) {
  Span span{-unlimited, unlimited};
  const auto cover = [&span](const auto& table) {
    using Of = std::decay_t<decltype(table)>;
    if constexpr (std::is_same_v<Of, Table> || std::is_same_v<Of, TableReference>) {
      span.from = std::max(span.from, table.times.front());
      span.to = std::min(span.to, table.times.back());
    }
  };
  const auto cover_profile = [&](const Profile& profile) {
    for (const ProfileTerm& term : profile) std::visit(cover, term);
  };
  for_each_profile(scenario, cover_profile);
  const auto* const commands = commands_of(scenario);
  if (commands != nullptr) {
    cover_profile(commands->phi);
    cover_profile(commands->theta);
  } else if (scenario.controller) {
    std::visit(cover, scenario.controller->reference);
  }
  return span;
}

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
