// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// When the iteration for a step's stages has converged.
//
// Included only by the kernels; see simd/pack.hpp for why all is inlined or tagged.
#pragma once

#include "simd/compare.hpp"

namespace bbsim::solve {

// Changes and distances are in the weights of the tolerance: 1 is all that the step may be wrong
// by.
struct StopTest {
  double enough;  // how far from its limit the iteration may end
  double floor;   // changes that rounding alone explains

  BBSIM_INLINE StopTest(double within, double rtol) : enough(within), floor(30 * 2.2e-16 / rtol) {}

  // Whether the last change was so small, or the changes still to come are. Each is `contraction`
  // times the one before, so they add up to change * contraction / (1 - contraction).
  BBSIM_INLINE bool passes(double change, double contraction) const {
    return change <= floor || change * contraction <= enough * (1 - contraction);
  }
  // Another iteration in each lane.
  template <class P>
  BBSIM_INLINE typename P::Mask passes(P change, P contraction) const {
    return (change.v <= P(floor).v) |
           ((change * contraction).v <= (P(enough) * (P(1.0) - contraction)).v);
  }
};

}  // namespace bbsim::solve
