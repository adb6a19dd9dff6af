// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The direction in which a motion starts from rest.
#pragma once

#include <cmath>
#include <numbers>
#include <utility>

namespace bbsim::model {

// Angles closer than this count as equal: rounding is 1e-16 of the accelerations that cancel.
inline constexpr double equal_angles = 1e-14;

// Angle of a motion from rest that is parallel to its acceleration, rad; `last` if none is found.
// turned(a) is the angle from a motion at angle a to its acceleration; turned(last) is f_last.
template <class Turned>
double start_angle(const Turned& turned, double last, double f_last) {
  constexpr double half_turn = std::numbers::pi;
  const double at = last;
  // The direction of the acceleration is often the solution; the secant method starts there.
  double next = last + f_last;
  for (int i = 0; i < 12 && std::abs(f_last) > equal_angles; ++i) {
    const double f = turned(next), slope = (f - f_last) / (next - last);
    last = std::exchange(next, next - f / slope);
    f_last = f;
    if (!(std::abs(next - last) < half_turn)) break;
  }
  if (std::abs(f_last) <= equal_angles || std::abs(next - last) <= equal_angles) return last;
  // Otherwise searches the whole circle for a sign change by less than half a turn (no jump).
  constexpr int parts = 32;
  double from = at, f_from = turned(from);
  for (int i = 1; i <= parts; ++i) {
    double to = at + 2 * half_turn * i / parts, f_to = turned(to);
    if (f_from * f_to <= 0 && std::abs(f_from - f_to) < half_turn) {
      for (int k = 0; k < 100 && to - from > equal_angles; ++k) {
        const double middle = from + (to - from) / 2, f = turned(middle);
        if (f_from * f > 0) {
          from = middle;
          f_from = f;
        } else {
          to = middle;
        }
      }
      return from;
    }
    from = to;
    f_from = f_to;
  }
  return at;
}

}  // namespace bbsim::model
