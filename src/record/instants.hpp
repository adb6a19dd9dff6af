// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Measures of curves: step metrics, times of events on a curve, and values at these times.
#pragma once

#include <functional>

#include "record/curve.hpp"
#include "scenario/measures.hpp"

namespace bbsim::record {

// Returns the curve of a column.
using CurveOf = std::function<const Curve&(const scenario::Column&)>;

// The value of a measure; if it is NaN, `why` gives the reason in a few words.
struct Measured {
  double value;
  const char* why = nullptr;
};

// The value of a measure of kind step, when or find.
[[nodiscard]] Measured measured(const scenario::Measure& measure, const CurveOf& curve_of);

// Whether the measure is of kind step, when or find.
[[nodiscard]] inline bool is_of_curves(const scenario::Measure& measure) {
  using Kind = scenario::Measure::Kind;
  return measure.kind == Kind::step || measure.kind == Kind::when || measure.kind == Kind::find;
}

}  // namespace bbsim::record
