// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The measures that lanes can take.
#pragma once

#include <optional>
#include <vector>

#include "scenario/measures.hpp"
#include "solve/size.hpp"

namespace bbsim::sweep {

// Whether all are usual measures: any column at the end except gamma; the greatest tilt, tilt_rate
// and distance; the greatest and the rms of tracking_error. All must be of the whole run.
[[nodiscard]] bool are_usual_measures(const std::vector<scenario::Measure>& measures);

// The size whose greatest value a usual measure needs; empty for values at the end and rms.
[[nodiscard]] std::optional<solve::Size> size_of(const scenario::Measure& measure);

// The value of the column of this size.
[[nodiscard]] double value_of(solve::Size size, double value);

// Whether a sum of squares has lost nothing to overflow and underflow.
[[nodiscard]] inline bool is_square(double squared) {
  return squared > 1e-280 && squared < 1e300;
}

}  // namespace bbsim::sweep
