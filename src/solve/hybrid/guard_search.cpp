// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solve/hybrid/guard_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bbsim::solve {
namespace {

// Width of the differences that give slopes, as a fraction of the distance between two points.
constexpr double nudged = 1e-4;

}  // namespace

GuardSearch::GuardSearch(model::HybridSystem& run, Stepper& stepper)
    : run_(run),
      stepper_(stepper),
      first_(stepper.servos() != nullptr ? run.first_monitor() : 0),
      knowledge_(first_ == run.guards() ? Knowledge::unwatched : Knowledge::unarmed),
      guards_(run.guards()),
      row_size_(run.model().size() + (run.model().gamma ? 1 : 0)),
      row_(row_size_),
      values_(run.guards()),
      now_(run.guards()),
      near_(run.guards()),
      least_(run.guards()),
      most_(run.guards()) {}

double GuardSearch::state_at(double t, std::vector<double>& z) {
  stepper_.evaluate(&t, 1, row_.data());
  z.assign(row_.begin(), row_.begin() + static_cast<std::ptrdiff_t>(run_.model().size()));
  return row_.back();
}

void GuardSearch::arm(double t, const double* z) {
  if (knowledge_ == Knowledge::unwatched) return;
  knowledge_ = Knowledge::armed;
  run_.evaluate_guards(t, z, values_.data());
  for (std::size_t i = 0; i < guards_.size(); ++i) {
    guards_[i].value = values_[i];
    guards_[i].threshold = values_[i] > clearly(i) ? 0 : std::min(0.0, values_[i]) - clearly(i);
  }
}

double GuardSearch::predicted_stop(double t) {
  double soonest = std::numeric_limits<double>::infinity();
  paced_.resize(guards_.size());
  const bool armed = knowledge_ == Knowledge::armed;
  if (!armed && knowledge_ != Knowledge::unwatched) {
    state_at(t, z_);
    run_.evaluate_guards(t, z_.data(), values_.data());
  }
  for (std::size_t i = 0; i < guards_.size(); ++i) {
    const double value = armed ? guards_[i].value : values_[i], fallen = paced_[i] - value;
    if (run_.stops(i) && fallen > 0) {
      soonest = std::min(soonest, t + value * (t - paced_time_) / fallen);
    }
    paced_[i] = value;
  }
  paced_time_ = t;
  return soonest;
}

// How far guard i is above its threshold at t.
double GuardSearch::above(std::size_t i, double t) {
  state_at(t, z_);
  run_.evaluate_guards(t, z_.data(), values_.data());
  return values_[i] - guards_[i].threshold;
}

// The first time in (from, to] at which guard i is not above its threshold. The guard must be above
// it at `from`, and not at `to`. Uses regula falsi, with a bisection after each step that does not
// halve the bracket.
double GuardSearch::root(std::size_t i, double from, double to) {
  double f_from = above(i, from), f_to = above(i, to);
  bool halve = false;
  for (int k = 0; k < 200; ++k) {
    const double width = to - from;
    if (width <= 2 * std::numeric_limits<double>::epsilon() * std::abs(to)) break;
    double middle = from + width * (f_from / (f_from - f_to));
    if (halve || !(middle > from && middle < to)) middle = from + width / 2;
    if (middle <= from || middle >= to) break;
    const double f = above(i, middle);
    if (f > 0) {
      from = middle;
      f_from = f;
    } else {
      to = middle;
      f_to = f;
    }
    halve = to - from > width / 2;
  }
  return to;
}

// Golden-section search for the minimum of guard i within [from, to]. Returns a time at which the
// guard is not above its threshold, or `from` if it finds none.
double GuardSearch::dip(std::size_t i, double from, double to) {
  constexpr double golden = 0.6180339887498949;
  double a = from, b = to;
  double c = b - golden * (b - a), d = a + golden * (b - a);
  double fc = above(i, c), fd = above(i, d);
  for (int k = 0; k < 60 && b - a > 1e-12 * b; ++k) {
    if (fc <= 0) return c;
    if (fd <= 0) return d;
    if (fc < fd) {
      b = d;
      d = c;
      fd = fc;
      c = b - golden * (b - a);
      fc = above(i, c);
    } else {
      a = c;
      c = d;
      fc = fd;
      d = a + golden * (b - a);
      fd = above(i, d);
    }
  }
  return from;
}

// Time of point p, one of the points at which the search evaluates the step.
double GuardSearch::point(std::size_t p) const {
  if (p == points_) return to_;
  return from_ + (to_ - from_) * static_cast<double>(p) / static_cast<double>(points_);
}

// Evaluates the states at all times that the search visits if there is no crossing. One call for
// all times fills the SIMD lanes.
void GuardSearch::evaluate_planned() {
  planned_times_.clear();
  double last = from_;
  for (std::size_t p = 1; p <= points_; ++p) {
    const double here = point(p), nudge = (here - last) * nudged;
    planned_times_.insert(planned_times_.end(), {last + nudge, here - nudge, here});
    last = here;
  }
  planned_rows_.resize(planned_times_.size() * row_size_);
  stepper_.evaluate(planned_times_.data(), planned_times_.size(), planned_rows_.data());
  next_planned_ = 0;
}

// Evaluates all guards at t, from the planned rows if it can.
void GuardSearch::evaluate(double t, std::vector<double>& values) {
  if (next_planned_ < planned_times_.size() && planned_times_[next_planned_] == t) {
    run_.evaluate_guards(t, &planned_rows_[next_planned_ * row_size_], values.data());
    ++next_planned_;
    return;
  }
  next_planned_ = planned_times_.size();  // the search has left the planned times
  state_at(t, z_);
  run_.evaluate_guards(t, z_.data(), values.data());
}

// Returns whether all guards certainly stay positive. Bounds each by its values at Chebyshev points
// and the most that a polynomial can undershoot these. False for guards that are not finite.
bool GuardSearch::all_stay_positive(double from, double to) {
  const ChebyshevPoints& points = tables_.points(stepper_.parts());
  const std::size_t count = points.size();
  planned_times_.resize(count);
  for (std::size_t p = 0; p < count; ++p) planned_times_[p] = from + (to - from) * points[p];
  planned_times_.back() = to;
  planned_rows_.resize(count * row_size_);
  stepper_.evaluate(planned_times_.data(), count, planned_rows_.data());
  for (std::size_t i = first_; i < guards_.size(); ++i) {
    if (guards_[i].threshold != 0) return false;  // starts at zero: the search decides
    least_[i] = most_[i] = guards_[i].value;
  }
  for (std::size_t p = 0; p < count; ++p) {
    run_.evaluate_guards(planned_times_[p], &planned_rows_[p * row_size_], now_.data());
    for (std::size_t i = first_; i < guards_.size(); ++i) {
      if (std::isnan(now_[i])) return false;
      least_[i] = std::min(least_[i], now_[i]);
      most_[i] = std::max(most_[i], now_[i]);
    }
  }
  for (std::size_t i = first_; i < guards_.size(); ++i) {
    if (std::isinf(least_[i]) && least_[i] > 0) continue;  // not monitored
    if (!(least_[i] - points.overshoot() * (most_[i] - least_[i]) > 0)) return false;
  }
  for (std::size_t i = 0; i < guards_.size(); ++i) guards_[i].value = now_[i];
  return true;
}

model::Effect GuardSearch::begin(double from, double to) {
  from_ = last_ = from;
  to_ = to;
  points_ = 0;
  point_ = 1;  // after the last point: nothing to search yet
  if (knowledge_ == Knowledge::unwatched || knowledge_ == Knowledge::proven) {
    return model::Effect::none;
  }
  if (stepper_.servos() != nullptr) {
    const bool unchecked = this->unchecked();
    if (stepper_.no_monitor_changes(run_.occurring())) {
      knowledge_ = Knowledge::proven;
      return model::Effect::none;
    }
    if (knowledge_ != Knowledge::armed) {
      const double integral = state_at(from, z_);
      if (unchecked) {
        const model::Effect effect = run_.check_events(from, z_.data());
        run_.log().note_turned(integral);
        if (effect == model::Effect::stop) return effect;
      }
      arm(from, z_.data());
    }
  }
  if (all_stay_positive(from, to)) return model::Effect::none;
  points_ = stepper_.detail();
  evaluate_planned();
  return model::Effect::none;
}

// Whether a guard that is positive at both ends of an interval may be negative between: it falls at
// the start, rises at the end, and its end tangents meet at zero or below.
template <class Guard>
static bool may_dip(const Guard& guard, double end_value, double end_slope, double width) {
  if (guard.threshold != 0 || !(guard.slope < 0) || !(end_slope > 0)) return false;
  const double meet = (end_value - guard.value - end_slope * width) / (guard.slope - end_slope);
  return guard.value + guard.slope * meet <= 0;
}

// The first crossing in (from, to], from values and slopes at both ends. Slopes are differences,
// accurate to a few parts in 1e4.
std::optional<model::Crossing> GuardSearch::first_crossing(double from, double to) {
  const double width = to - from, nudge = width * nudged;
  evaluate(from + nudge, near_);
  for (std::size_t i = first_; i < guards_.size(); ++i) {
    guards_[i].slope = (near_[i] - guards_[i].value) / nudge;
  }
  evaluate(to - nudge, near_);
  evaluate(to, now_);
  std::optional<model::Crossing> first;
  for (std::size_t i = first_; i < guards_.size(); ++i) {
    // An infinite guard is not monitored. If a guard is NaN, the motion overflows, and the
    // stepper reports that.
    if (!std::isfinite(now_[i])) continue;
    double low = to;
    if (now_[i] > guards_[i].threshold) {
      if (!may_dip(guards_[i], now_[i], (now_[i] - near_[i]) / nudge, width)) continue;
      low = dip(i, from, to);
      if (low == from) continue;
    }
    const double t = root(i, from, low);
    if (!first || t < first->time) first = {t, i};
  }
  return first;
}

std::optional<model::Crossing> GuardSearch::next() {
  for (; point_ <= points_; ++point_) {
    const double here = point(point_);
    if (!(here > last_)) continue;
    if (const auto crossing = first_crossing(last_, here)) return crossing;
    for (std::size_t i = 0; i < guards_.size(); ++i) {
      guards_[i].value = now_[i];
      if (now_[i] > clearly(i)) guards_[i].threshold = 0;
    }
    last_ = here;
  }
  return {};
}

void GuardSearch::resume(double t, const double* z) {
  arm(t, z);
  last_ = t;
}

}  // namespace bbsim::solve
