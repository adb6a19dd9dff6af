#include "record/instants.hpp"

#include <algorithm>
#include <cmath>

#include "base/real.hpp"

namespace bbsim::record {
namespace {

using scenario::Instant;
using scenario::Measure;
using scenario::StepMetric;

// As python-control's step_info() has them, of all instants in place of its samples.
double step_metric(const Curve& curve, StepMetric metric) {
  const double end = curve.end_value(), size = std::abs(end), sign = end < 0 ? -1 : 1;
  if (metric == StepMetric::steady_state_value) return end;
  if (metric == StepMetric::peak || metric == StepMetric::peak_time) {
    const Curve::Extreme up = curve.greatest(1), down = curve.greatest(-1);
    const bool above = up.value > -down.value || (up.value == -down.value && up.t <= down.t);
    const Curve::Extreme& most = above ? up : down;
    return metric == StepMetric::peak ? std::abs(most.value) : most.t;
  }
  if (end == 0) return no_number;
  const auto risen = curve.first_at_least(sign, 0.9 * size);
  switch (metric) {
    case StepMetric::rise_time:
      return risen->t - curve.first_at_least(sign, 0.1 * size)->t;
    case StepMetric::settling_time: {
      const auto above = curve.last_at_least(sign, 1.02 * size);
      const auto below = curve.last_at_least(-sign, -0.98 * size);
      return std::max(above ? above->t : curve.start(), below ? below->t : curve.start());
    }
    case StepMetric::settling_min:
      return curve.greatest(-1, risen).value;
    case StepMetric::settling_max:
      return curve.greatest(1, risen).value;
    case StepMetric::overshoot:
      return std::max(0.0, 100 * (sign * curve.greatest(sign).value - size) / size);
    case StepMetric::undershoot:
      return std::max(0.0, -100 * sign * curve.greatest(-sign).value / size);
    case StepMetric::peak:
    case StepMetric::peak_time:
    case StepMetric::steady_state_value:
      break;
  }
  return no_number;
}

std::optional<Curve::Place> place_of(const Instant& instant, const Curve& curve) {
  switch (instant.kind) {
    case Instant::Kind::crosses:
      return curve.crossing(instant.level, instant.way, instant.number);
    case Instant::Kind::at:
      return curve.place_at(instant.level);
    case Instant::Kind::stays_below:
    case Instant::Kind::stays_above:
      break;
  }
  const double sign = instant.kind == Instant::Kind::stays_below ? 1 : -1;
  if (sign * curve.end_value() >= sign * instant.level) return {};  // it does not
  const auto last = curve.last_at_least(sign, sign * instant.level);
  return last ? last : curve.place_at(curve.start());
}

}  // namespace

double measured(const Measure& measure, const CurveOf& curve_of) {
  const Curve& curve = curve_of(*measure.column);
  if (curve.empty()) return no_number;
  if (measure.kind == Measure::Kind::step) return step_metric(curve, measure.metric);
  const Instant& instant = measure.instant;
  const Curve& watched = instant.column != nullptr ? curve_of(*instant.column) : curve;
  if (watched.empty()) return no_number;
  const std::optional<Curve::Place> place = place_of(instant, watched);
  if (!place) return no_number;
  return measure.kind == Measure::Kind::when ? place->t : curve.value(*place);
}

}  // namespace bbsim::record
