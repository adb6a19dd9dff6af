// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Finds the greatest values between Chebyshev points, over many stretches of time.
#pragma once

#include <cstddef>
#include <vector>

#include "base/chebyshev.hpp"
#include "record/track/kernels/track_kernels.hpp"

namespace bbsim::record {

// A stretch: the points of `parts` intervals, from index `first` on.
struct Span {
  std::size_t first, parts;
};

// Whether a sum of squares has lost nothing to overflow and underflow.
[[nodiscard]] inline bool is_square(double squared) {
  return squared > 1e-280 && squared < 1e300;
}

// The density of the points. close: the points themselves show each maximum. wide: only the
// polynomial through them does, so the search also needs values between them.
enum class Spacing { close, wide };

// Finds the greatest values of polynomials through values that are not negative.
class SpanSearch {
 public:
  SpanSearch() : kernels_(choose_track_kernels()) {}

  [[nodiscard]] const ChebyshevPoints& points(std::size_t parts) { return tables_.points(parts); }

  // The greatest value over all spans. `greatest` must be at least the greatest of the values, and
  // is returned if nothing exceeds it. Spans are in order, from the first value on. Values are
  // aligned and padded for the kernels.
  [[nodiscard]] double greatest_between(const std::vector<Span>& spans, const double* values,
                                        Spacing spacing, double greatest);
  // The same within a single span.
  [[nodiscard]] double greatest_within(std::size_t parts, const double* values, Spacing spacing,
                                       double greatest);

 private:
  const TrackKernels& kernels_;
  ChebyshevTables tables_;
  std::vector<unsigned char> above_;
  std::vector<double> finer_;
};

}  // namespace bbsim::record
