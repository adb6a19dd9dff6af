// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "record/instants.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/instant.hpp"
#include "base/number_text.hpp"
#include "base/real.hpp"

namespace bbsim::record {
namespace {

using scenario::Instant;
using scenario::Measure;
using scenario::StepMetric;

Measured nothing(const char* why) {
  return {no_number, why};
}

// A step of a column, from its start to the value that it should reach.
struct Step {
  double start, end;
  [[nodiscard]] double size() const { return std::abs(end - start); }
  [[nodiscard]] double sign() const { return end < start ? -1 : 1; }
  // Whether start and end differ by rounding only.
  [[nodiscard]] bool is_none() const {
    return !(size() > rounding_of(std::max(std::abs(start), std::abs(end))));
  }
};

Measured peak(const Curve& curve, StepMetric metric, double start) {
  const Curve::Extreme up = curve.greatest(1), down = curve.greatest(-1);
  const double above = up.value - start, below = start - down.value;
  const Curve::Extreme& most = above > below || (above == below && up.t <= down.t) ? up : down;
  return {metric == StepMetric::peak ? std::abs(most.value) : most.t - curve.start()};
}

// As in python-control's step_info(), but over all instants instead of samples, and for a step that
// may start anywhere.
Measured step_metric(const Curve& curve, StepMetric metric, const Step& step) {
  if (step.is_none()) return nothing("it should end where it starts, so its step is 0");
  const double size = step.size(), sign = step.sign();
  const double start = sign * step.start, end = sign * step.end;
  const auto risen = [&](double part) { return curve.first_at_least(sign, start + part * size); };
  const auto high = risen(0.9);
  constexpr const char* not_risen = "it does not reach 90 % of its step";
  switch (metric) {
    case StepMetric::rise_time:
      if (!high) return nothing(not_risen);
      return {high->t - risen(0.1)->t};
    case StepMetric::settling_time: {
      const double band = 0.02 * size;
      if (curve.ends_at_least(sign, end + band) || curve.ends_at_least(-sign, band - end)) {
        return nothing("it does not end within 2 % of its step");
      }
      const auto above = curve.last_at_least(sign, end + band);
      const auto below = curve.last_at_least(-sign, band - end);
      const double first = curve.start();
      return {std::max(above ? above->t : first, below ? below->t : first) - first};
    }
    case StepMetric::settling_min:
    case StepMetric::settling_max:
      if (!high) return nothing(not_risen);
      return {curve.greatest(metric == StepMetric::settling_max ? 1 : -1, high).value};
    case StepMetric::overshoot:
      return {std::max(0.0, 100 * (sign * curve.greatest(sign).value - end) / size)};
    case StepMetric::undershoot:
      return {std::max(0.0, 100 * (start - sign * curve.greatest(-sign).value) / size)};
    case StepMetric::peak:
    case StepMetric::peak_time:
      return peak(curve, metric, step.start);
    case StepMetric::steady_state_value:
      break;
  }
  return {curve.end_value()};
}

struct Found {
  std::optional<Curve::Place> place;
  const char* why = nullptr;
};

Found place_of(const Instant& instant, const Curve& curve) {
  switch (instant.kind) {
    case Instant::Kind::crosses:
      return {curve.crossing(instant.level, instant.way, instant.number), "it does not happen"};
    case Instant::Kind::at:
      return {curve.place_at(instant.level), "the time is outside the measured part"};
    case Instant::Kind::stays_below:
    case Instant::Kind::stays_above:
      break;
  }
  // A change of sign turns above into below.
  const double sign = instant.kind == Instant::Kind::stays_below ? 1 : -1;
  if (curve.ends_at_least(sign, sign * instant.level)) return {{}, "it does not stay there"};
  const auto last = curve.last_at_least(sign, sign * instant.level);
  return {last ? last : curve.place_at(curve.start())};
}

}  // namespace

Measured measured(const Measure& measure, const CurveOf& curve_of) {
  constexpr const char* no_value = "there is no finite value";
  const Curve& curve = curve_of(*measure.column);
  if (curve.empty()) return nothing(no_value);
  if (measure.kind == Measure::Kind::step) {
    const Curve* const reference =
        measure.reference != nullptr ? &curve_of(*measure.reference) : nullptr;
    const bool is_meant = reference != nullptr && !reference->empty();
    const double end = is_meant ? reference->end_value() : curve.end_value();
    return step_metric(curve, measure.metric, {curve.start_value(), end});
  }
  const Instant& instant = measure.instant;
  const Curve& watched = instant.column != nullptr ? curve_of(*instant.column) : curve;
  if (watched.empty()) return nothing(no_value);
  const Found found = place_of(instant, watched);
  if (!found.place) return nothing(found.why);
  if (measure.kind == Measure::Kind::when) return {found.place->t};
  const double value = curve.value(*found.place);
  return {value, std::isnan(value) ? no_value : nullptr};
}

}  // namespace bbsim::record
