// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Values at Chebyshev points of one stretch of time after another, and what they are greatest at
// between the points.
#pragma once

#include <cstddef>
#include <vector>

#include "base/chebyshev.hpp"
#include "record/track/kernels/track_kernels.hpp"

namespace bbsim::record {

// One stretch: the points of so many intervals, from place `first` on.
struct Span {
  std::size_t first, parts;
};

// Whether a sum of squares has lost nothing to overflow and underflow.
[[nodiscard]] inline bool is_square(double squared) {
  return squared > 1e-280 && squared < 1e300;
}

// How many points there are to half a wave of the values: enough to see each maximum among them, or
// enough for the polynomial through them, which then has to be looked at more closely.
enum class Spacing { close, wide };

// The greatest values of polynomials through values that are not negative.
class SpanSearch {
 public:
  SpanSearch() : kernels_(choose_track_kernels()) {}

  [[nodiscard]] const ChebyshevPoints& points(std::size_t parts) { return tables_.points(parts); }

  // Where they are greater than `greatest`, which is the greatest of the values or more; spans in
  // their order, from the first value on, which is aligned and padded as for the kernels.
  [[nodiscard]] double greatest_between(const std::vector<Span>& spans, const double* values,
                                        Spacing spacing, double greatest);
  // Looks in the same way within a single span.
  [[nodiscard]] double greatest_within(std::size_t parts, const double* values, Spacing spacing,
                                       double greatest);

 private:
  const TrackKernels& kernels_;
  ChebyshevTables tables_;
  std::vector<unsigned char> above_;
  std::vector<double> finer_;
};

}  // namespace bbsim::record
