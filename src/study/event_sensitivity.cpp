// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "study/event_sensitivity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <variant>

#include "base/instant.hpp"
#include "base/quoted.hpp"
#include "base/short_number.hpp"
#include "model/systems/any_jacobian.hpp"

namespace bbsim::study {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using model::HybridSystem;

VectorXd rates(const HybridSystem& run, double t, const VectorXd& z) {
  return rates_of(run.model().system, run.model().size(), t, z.data());
}

double guard_at(const HybridSystem& run, std::size_t guard, double t, const VectorXd& z) {
  std::vector<double> values(run.guards());
  run.evaluate_guards(t, z.data(), values.data());
  return values[guard];
}

// Returns how long after t a guard crosses zero if the states z change at these rates; may be
// negative. NaN if it does not cross nearby, for example if the run only touches a limit.
double time_of_crossing(const HybridSystem& run, std::size_t guard, double t, const VectorXd& z,
                        const VectorXd& rates) {
  constexpr int most = 30;
  constexpr double first = 1e-7, precision = 1e-13;
  const auto value = [&](double after) {
    return guard_at(run, guard, t + after, z + after * rates);
  };
  // The secant method.
  double before = 0, after = first;
  double value_before = value(before), value_after = value(after);
  double step = after;
  for (int i = 0; i < most && value_after != 0 && value_after != value_before; ++i) {
    step = -value_after * (after - before) / (value_after - value_before);
    before = std::exchange(after, after + step);
    value_before = std::exchange(value_after, value(after));
    if (std::abs(step) <= precision * std::abs(after)) break;
  }
  // Go slightly past the crossing, whatever the rounding. This shifts all neighbors alike.
  constexpr double roundings = 64;
  step = std::max(precision * std::abs(after), roundings * rounding_of(t));
  for (int i = 0; i < most; ++i, step *= 2) {
    after += step;
    if (value(after) <= 0) return after;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

// Takes a neighboring system through the switches, from the states z at t with these rates.
EventSensitivity::Passed passed_switches(HybridSystem& beside,
                                         std::span<const HybridSystem::Switch> switches, double t,
                                         VectorXd z, VectorXd z_rates) {
  double later = 0;
  for (const HybridSystem::Switch& one : switches) {
    if (one.guard) {
      const double step = time_of_crossing(beside, *one.guard, t + later, z, z_rates);
      later += step;
      z += step * z_rates;
      if (!std::isfinite(step)) break;
      static_cast<void>(beside.handle_state_event(*one.guard, t + later, z.data()));
    } else {
      beside.handle_time_event(t, z.data());
    }
    z_rates = rates(beside, t + later, z);
  }
  return {later, z - later * z_rates, z_rates};
}

model::Modes without_directions(model::Modes modes) {
  modes.contact.roll = modes.contact.slip = {};
  return modes;
}

}  // namespace

void EventSensitivity::begin_run() {
  beside_.clear();
  passed_ = 0;
  last_mode_ = model_.system;
}

void EventSensitivity::make_systems(const HybridSystem& run) {
  for (const Neighbors& neighbors : keys_) {
    Beside& of_key = beside_.emplace_back();
    for (const model::Model& model : neighbors.models) {
      of_key.push_back(std::make_unique<HybridSystem>(model, run.resolution()));
    }
  }
}

VectorXd EventSensitivity::pass(const SwitchInstant& now, Eigen::MatrixXd& slopes) {
  if (beside_.empty()) make_systems(now.run);
  VectorXd moves = VectorXd::Zero(slopes.cols());
  const std::size_t missed = now.run.switches() - passed_;
  if (missed == 0) return moves;
  passed_ += missed;
  if (missed > now.run.latest_switches().size()) {
    no_sensitivity("at t = " + short_number(now.t) +
                   " s the scene switches many times at once, which has no derivative; allowed: "
                   "runs that end before");
  }
  const auto switches = std::span(now.run.latest_switches()).last(missed);
  const auto n = static_cast<Index>(model_.size());
  constexpr double rounding = 1e-9;
  const double moved = (now.after.head(n) - now.before.head(n)).cwiseAbs().maxCoeff();
  const bool starts = now.t == 0;
  const bool jumps = starts || moved > rounding * now.before.head(n).cwiseAbs().maxCoeff();
  const model::Modes before = model::modes_of(last_mode_);
  const model::Modes after = model::modes_of(now.run.model().system);
  // A guard may cross several times by rounding before anything switches. Modes do not include the
  // piece of a linkage's curve.
  const bool has_pieces = model_.rig && model_.rig->between.has_pieces();
  if (!jumps && before == after && !has_pieces) return moves;
  // Near rest, a tiny move turns a velocity arbitrarily. If a direction is held, nothing jumps.
  const bool only_holds = !jumps && without_directions(before) == without_directions(after);
  if (only_holds) note_alignment(now);
  for (std::size_t k = 0; k < keys_.size(); ++k) {
    const auto column = static_cast<Index>(k);
    auto slope = slopes.col(column);
    const std::vector<Passed> passed = pass_beside(k, now, switches, only_holds, slope);
    for (const auto& beside : beside_[k]) beside->follow_friction(after);
    for (std::size_t j = 0; j < passed.size(); ++j) {
      keys_[k].models[j].system = beside_[k][j]->model().system;
    }
    if (!only_holds) moves[column] = jump(k, now, passed, slope);
  }
  if (!only_holds) alignment_.reset();
  last_mode_ = now.run.model().system;
  return moves;
}

// Dry friction along a velocity turns S into its direction, faster the slower the motion. Before
// the direction is held, one eigenvalue -rate of the Jacobian dominates. The Jacobian is then -rate
// times a projection, and its trace is -rate.
void EventSensitivity::note_alignment(const SwitchInstant& now) {
  constexpr double least_rate = 1e6;  // 1/s
  const auto n = static_cast<Index>(model_.size());
  Eigen::MatrixXd jacobian(n, n);
  model::jacobian(last_mode_, now.t, now.before.data(), jacobian.data());
  const double rate = -jacobian.trace();
  if (rate > least_rate) alignment_ = jacobian / -rate;
}

// Takes the neighbors of key k through the switches; `at_rest`: from the run's own states.
std::vector<EventSensitivity::Passed> EventSensitivity::pass_beside(
    std::size_t k, const SwitchInstant& now, std::span<const HybridSystem::Switch> switches,
    bool at_rest, const Eigen::Ref<const VectorXd>& slope) {
  const auto n = static_cast<Index>(model_.size());
  std::vector<Passed> passed;
  for (std::size_t j = 0; j < Neighbors::offsets.size(); ++j) {
    HybridSystem& beside = *beside_[k][j];
    VectorXd z = now.before.head(n);
    if (!at_rest) z += Neighbors::offsets[j] * keys_[k].key.step * slope.head(n);
    const bool moves = now.t > 0;  // nothing moves before the start
    passed.push_back(passed_switches(beside, switches, now.t, z,
                                     moves ? rates(beside, now.t, z) : VectorXd::Zero(n)));
  }
  return passed;
}

// Sets the derivatives by key k after a switch. Returns how far the key moves the switch in time.
double EventSensitivity::jump(std::size_t k, const SwitchInstant& now,
                              const std::vector<Passed>& passed, Eigen::Ref<VectorXd> slope) const {
  const Neighbors& neighbors = keys_[k];
  const auto n = static_cast<Index>(model_.size());
  const auto of = [&passed](auto member) {
    return [&passed, member ](std::size_t j) -> const auto& {
      return passed[j].*member;
    };
  };
  // A neighbor that takes another branch at its switch is far from the others.
  const auto is_apart = [&](auto member, const VectorXd& own) {
    constexpr double close = 1e-3, rounding = 1e-10;
    constexpr std::size_t middle = Neighbors::offsets.size() / 2;
    const double step = neighbors.key.step;
    const VectorXd good = neighbors.slope(of(member));
    const VectorXd fair = difference(fourth_order, middle, step, of(member));
    const VectorXd center = (passed[middle - 1].*member + passed[middle].*member) / 2;
    const double most = good.cwiseAbs().maxCoeff();
    const double least = rounding * own.cwiseAbs().maxCoeff();
    return !((good - fair).cwiseAbs().maxCoeff() <= close * most + least / step &&
             (center - own).cwiseAbs().maxCoeff() <= step * most + least);
  };
  if (is_apart(&Passed::moved, now.after.head(n)) ||
      is_apart(&Passed::rates, now.rates_after.head(n))) {
    no_sensitivity(shown(neighbors.key.name) + ": at t = " + short_number(now.t) +
                   " s the run touches a limit, or switches twice at once, and a slightly "
                   "different value of this key leads to another motion, so there is no "
                   "derivative; allowed: runs that end before");
  }
  const double later = neighbors.slope(of(&Passed::later));
  const VectorXd before = slope.head(n);
  slope.head(n) = neighbors.slope(of(&Passed::moved));
  if (alignment_) {
    // The held direction is that of a velocity near rounding. Friction would have turned the part
    // of S across the final direction into it, so remove this part. States at rest stay at rest.
    const VectorXd turned = *alignment_ * (before + later * now.rates_before.head(n));
    for (Index i = 0; i < n; ++i) {
      if (now.after[i] != 0 || slope[i] != 0) slope[i] -= turned[i];
    }
  }
  if (slope.size() > n) slope[n] += later * (now.rates_before[n] - now.rates_after[n]);
  return later;
}

VectorXd EventSensitivity::extras(std::size_t k, double t, const VectorXd& z,
                                  const VectorXd& slope) const {
  VectorXd found = slope_of_extras(keys_[k], t, z, slope);
  // Without samples, the measured position is the ball's.
  if (model_.rig) found.segment(measured_extras, 2) = slope.head(2);
  return found;
}

}  // namespace bbsim::study
