// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The maximum of a function of one variable, with a different function in each lane.
#pragma once

#include "simd/compare.hpp"

namespace bbsim::simd {

// Value and slope of a function at a place.
template <class P>
struct HermitePoint {
  P at, value, slope;
};

// An upper bound between two places, from the cubic through values and slopes at both. The cubic is
// monotonic if both slopes have the sign of the change and neither exceeds three times the mean
// slope (Fritsch and Carlson, SIAM Journal on Numerical Analysis 17:238, 1980). Otherwise it
// exceeds the ends by at most 4/27 of the changes that its end slopes would make. The factor used,
// 0.25, allows for terms of higher degree.
template <class P>
BBSIM_INLINE P promise_between(const HermitePoint<P>& from, const HermitePoint<P>& to) {
  using Mask = typename P::Mask;
  constexpr double beyond = 0.25;
  const P width = to.at - from.at, change = to.value - from.value;
  const P s0 = width * from.slope, s1 = width * to.slope;
  const P steepest = P(3.0) * size_of(change);
  const Mask one_way = (Mask)((s0 * change).v >= 0) & (Mask)((s1 * change).v >= 0) &
                       (Mask)(size_of(s0).v <= steepest.v) & (Mask)(size_of(s1).v <= steepest.v);
  const P more = P(beyond) * (larger_of(s0, P(0.0)) + larger_of(-s1, P(0.0)));
  return larger_of(from.value, to.value) + choose(one_way, P(0.0), more);
}

// Climbs to the maximum between two places by successive cubics. Raises `greatest` to each value on
// the way, in the lanes of `wanted`, until each lane is done.
template <class P, class Evaluate>
BBSIM_INLINE void climb(HermitePoint<P> from, HermitePoint<P> to, typename P::Mask wanted,
                        P& greatest, Evaluate evaluate) {
  using Mask = typename P::Mask;
  constexpr int most_steps = 8;
  constexpr double close = 1e-12, edge = 1e-3;
#pragma GCC unroll 1
  for (int step = 0; step < most_steps; ++step) {
    const P width = to.at - from.at, change = to.value - from.value;
    const P s0 = width * from.slope, s1 = width * to.slope;
    // The cubic's slope is s0 + 2 b u + 3 a u^2. Its maximum is where the slope falls through zero.
    const P a = s0 + s1 - P(2.0) * change, b = P(3.0) * change - P(2.0) * s0 - s1;
    const P root = root_of(larger_of(b * b - P(3.0) * a * s0, P(0.0)));
    const P under = root - b;
    const Mask inside = (Mask)(under.v > 0) & (Mask)(s0.v > 0) & (Mask)(s0.v < under.v);
    const P part = choose(inside, s0 / choose(inside, under, P(1.0)), P(0.5));
    HermitePoint<P> next;
    next.at = from.at + width * larger_of(P(edge), smaller_of(part, P(1 - edge)));
    evaluate(next.at, next.value, next.slope);
    greatest = choose(wanted, larger_of(greatest, next.value), greatest);
    // The possible gain, of a parabola with the curvature given by the two end slopes.
    const P bend = from.slope - to.slope;
    const P left = next.slope * next.slope * width;
    wanted &= (Mask)(left.v > (P(close) * greatest * bend).v);
    if (!any_of<P>(wanted)) return;
    const Mask rising = next.slope.v > 0;
    from = {choose(rising, next.at, from.at), choose(rising, next.value, from.value),
            choose(rising, next.slope, from.slope)};
    to = {choose(rising, to.at, next.at), choose(rising, to.value, next.value),
          choose(rising, to.slope, next.slope)};
  }
}

// Raises `greatest` to the maximum of a function over `count` places, in order, and between them.
// `most`: the largest count. evaluate(at, value, slope) gives the function elsewhere.
template <int most, class P, class Evaluate>
BBSIM_INLINE void raise_to_peak(const HermitePoint<P>* places, int count, P& greatest,
                                Evaluate evaluate) {
  using Mask = typename P::Mask;
  constexpr double worth = 1 + 1e-9;  // intervals with less to gain are skipped
  P promise[most];
  greatest = larger_of(greatest, places[0].value);
#pragma GCC unroll 1
  for (int i = 0; i + 1 < count; ++i) {
    greatest = larger_of(greatest, places[i + 1].value);
    promise[i] = promise_between(places[i], places[i + 1]);
  }
  // Usually few intervals remain, if any.
  int promising[most], left = 0;
  const P enough = P(worth) * greatest;
#pragma GCC unroll 1
  for (int i = 0; i + 1 < count; ++i) {
    promising[left] = i;
    left += any_of<P>((Mask)(promise[i].v > enough.v)) ? 1 : 0;
  }
  // Each lane searches the interval with the highest bound for it.
#pragma GCC unroll 1
  for (int round = 0; round < left; ++round) {
    P best = P(worth) * greatest, number(-1.0);
    HermitePoint<P> from = places[promising[0]], to = places[promising[0] + 1];
#pragma GCC unroll 1
    for (int k = 0; k < left; ++k) {
      const int i = promising[k];
      const Mask better = promise[i].v > best.v;
      best = choose(better, promise[i], best);
      number = choose(better, P(double(i)), number);
      from = {choose(better, places[i].at, from.at), choose(better, places[i].value, from.value),
              choose(better, places[i].slope, from.slope)};
      to = {choose(better, places[i + 1].at, to.at), choose(better, places[i + 1].value, to.value),
            choose(better, places[i + 1].slope, to.slope)};
    }
    const Mask found = number.v >= 0;
    if (!any_of<P>(found)) return;
    climb(from, to, found, greatest, evaluate);
#pragma GCC unroll 1
    for (int k = 0; k < left; ++k) {
      P& of = promise[promising[k]];
      of = choose((Mask)(number.v == P(double(promising[k])).v), P(0.0), of);
    }
  }
}

}  // namespace bbsim::simd
