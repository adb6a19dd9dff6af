// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The convergence test of the iteration for a step's stages.
//
// Included only by the kernels. See simd/pack.hpp for why everything is inlined or tagged.
#pragma once

#include "simd/compare.hpp"

namespace bbsim::solve {

// Changes and distances are relative to the tolerance: 1 is the error that a step may have.
struct StopTest {
  double enough;  // the distance from the limit at which the iteration may end
  double floor;   // changes below it are rounding

  BBSIM_INLINE StopTest(double within, double rtol) : enough(within), floor(30 * 2.2e-16 / rtol) {}

  // Whether the last change is below the floor, or the sum of the changes to come is small enough.
  // Each change is `contraction` times the one before, so they add up to
  // change * contraction / (1 - contraction).
  BBSIM_INLINE bool passes(double change, double contraction) const {
    return change <= floor || change * contraction <= enough * (1 - contraction);
  }
  // The same for an independent iteration in each lane.
  template <class P>
  BBSIM_INLINE typename P::Mask passes(P change, P contraction) const {
    return (change.v <= P(floor).v) |
           ((change * contraction).v <= (P(enough) * (P(1.0) - contraction)).v);
  }
};

}  // namespace bbsim::solve
