// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sweep/clock_shift.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <numbers>
#include <type_traits>

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

}  // namespace

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

Span span_of_tables(const Scenario& scenario) {
  constexpr double unlimited = std::numeric_limits<double>::infinity();
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

}  // namespace bbsim::sweep
