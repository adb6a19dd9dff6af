// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "record/track/spans.hpp"

#include <algorithm>

#include "base/maxima.hpp"

namespace bbsim::record {
namespace {

// A polynomial exceeds its values at Chebyshev points by at most this part of their range: (L - 1)
// / 2, with the Lebesgue constant L <= 1 + 2 / pi log(129) up to degree 128.
constexpr double beyond = 1.55;

}  // namespace

// The values are not negative, so their range is at most the greatest one.
double SpanSearch::greatest_between(const std::vector<Span>& spans, const double* values,
                                    Spacing spacing, double greatest) {
  if (spans.empty()) return greatest;
  const std::size_t count = spans.back().first + spans.back().parts + 1;
  above_.resize((count + row_padding - 1) / row_padding);
  kernels_.above(values, count, greatest / (1 + beyond), above_.data());
  for (const Span& span : spans) {
    const std::size_t last = span.first + span.parts;
    unsigned char above = 0;
    for (std::size_t block = span.first / row_padding; block <= last / row_padding; ++block) {
      above |= above_[block];
    }
    if (above == 0) continue;
    greatest = greatest_within(span.parts, values + span.first, spacing, greatest);
  }
  return greatest;
}

double SpanSearch::greatest_within(std::size_t parts, const double* values, Spacing spacing,
                                   double greatest) {
  const ChebyshevPoints& points = tables_.points(parts);
  const auto look_closer = [&](const Bracket& bracket) {
    const Peak peak = climb(bracket, good_place * (bracket.to.at - bracket.from.at),
                            [&](double s) { return points.at(values, s); });
    if (peak.value > greatest) greatest = peak.value;
  };
  if (spacing == Spacing::close) {
    for_each_bracket(points, values, greatest, Between::smooth, look_closer);
  } else {
    refine(points, values, greatest, finer_);
    for_each_bracket(tables_.points(2 * parts), finer_.data(), greatest, Between::smooth,
                     look_closer);
  }
  return greatest;
}

}  // namespace bbsim::record
