// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The mechanism between servo and plane: horn, push rod and arm, or a measured curve
// (docs/explanation/rig-model.md, "Linkages"). Plain data and templates for every number type;
// linkages.hpp builds them from a scenario.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/real.hpp"
#include "model/ball/rolling.hpp"
#include "model/signals/spline.hpp"

namespace bbsim::model {

// The largest number of servos of a gimbal.
inline constexpr int most_servos = 3;

// The servos turn the plane directly.
struct Direct {
  static constexpr bool direct = true;
  static constexpr int servos = 2;
};

// The angle of the plane as a function of the servo's angle: sine, cosine, and the first and second
// derivative with respect to the servo's angle.
template <class Real>
struct Turn {
  Real sin, cos, slope, bend;
};

// The angle of a direction. Its sine and cosine are those of a vector of length 1. Each iteration
// reduces the error e to e^3 / 6.
template <class Real>
[[nodiscard]] Real angle_of(const Real& sine, const Real& cosine) {
  Real angle = sine;
  for (int i = 0; i < 9; ++i) {
    const SinCos<Real> at = sin_cos(angle);
    angle = angle + (sine * at.cos - cosine * at.sin);
  }
  return angle;
}
[[nodiscard]] inline double angle_of(double sine, double cosine) {
  return cosine > 0.7 ? std::asin(sine) : std::atan2(sine, cosine);  // the first is faster
}

// The middle of a range of angles. angle_of() returns angles within half a turn of it, so that
// angles more than half a turn from 0 do not wrap around.
struct RangeMiddle {
  double angle = 0, cos = 1, sin = 0;

  // The middle of `low` to `high`, rad; 0 if the range is well within half a turn of 0.
  [[nodiscard]] static RangeMiddle of(double low, double high) {
    constexpr double well_within = 2.5;
    if (!(high - low < HUGE_VAL) || std::max(-low, high) <= well_within) return {};
    const double middle = low + (high - low) / 2;
    return {middle, std::cos(middle), std::sin(middle)};
  }

  // The angle of a direction, within half a turn of the middle.
  template <class Real>
  [[nodiscard]] Real angle_of(const Real& sine, const Real& cosine) const {
    return Real(angle) + model::angle_of(cos * sine - sin * cosine, cos * cosine + sin * sine);
  }
};

// Two bars on separate axes, joined by a rod between their ends. Lengths in m; the servo's axis is
// at (0, 0). arm_side and horn_side select one of the two solutions.
//
// For a bar much shorter than the rod, the direction depends on the small difference of two large
// squares. Each is therefore counted from its value at angle zero, without cancellation.
struct Rods {
  double horn = 0, arm = 0, rod = 0;
  double x = 0, z = 0;  // of the arm's axis
  double arm_side = 1, horn_side = 1;
  RangeMiddle horn_middle{}, arm_middle{};
  // The square of |v|, (M55), over that of the rod with the horn at zero; and of |v| of the inverse
  // with the arm at zero, m^2.
  double arm_excess = 0, horn_excess = 0;

  void set_rod(double length) {
    rod = length;
    const auto excess = [&](double vx) {
      const double v = std::hypot(vx, z);
      return (v - rod) * (v + rod);
    };
    arm_excess = excess(horn - x);
    horn_excess = excess(x + arm);
  }

  // The direction of a bar from the origin whose end is at the rod's length from (vx, vz), and the
  // root in (M55). `excess`: the square of (vx, vz) over that of the rod, m^2.
  template <class Real>
  struct Bar {
    Real sin, cos, root;
  };
  template <class Real>
  [[nodiscard]] static Bar<Real> bar_to(const Real& vx, const Real& vz, const Real& excess,
                                        double bar, double side) {
    const Real v2 = vx * vx + vz * vz;
    const Real k = (0.5 / bar) * (excess + Real(bar * bar));
    const Real root = root_along(v2 - k * k, Real(side));
    return {(k * vz + root * vx) / v2, (k * vx - root * vz) / v2, root};
  }

  // Equations (M54) to (M56).
  template <class Real>
  [[nodiscard]] Turn<Real> arm_at(const Real& servo) const {
    const SinCos<Real> half = sin_cos(0.5 * servo);
    const Real h_sin = 2.0 * (half.sin * half.cos);
    const Real h_cos = Real(1.0) - 2.0 * (half.sin * half.sin);
    const Real vx = horn * h_cos - Real(x), vz = horn * h_sin - Real(z);
    const Real excess = Real(arm_excess) + (4 * horn) * (half.sin * (x * half.sin - z * half.cos));
    const Bar<Real> at = bar_to(vx, vz, excess, arm, arm_side);
    Turn<Real> turn;
    turn.sin = at.sin;
    turn.cos = at.cos;
    // The rod's vector, and its component across the arm.
    const Real px = arm * turn.cos - vx, pz = arm * turn.sin - vz;
    const Real by_arm = arm * at.root;
    turn.slope = (horn * (pz * h_cos - px * h_sin)) / by_arm;
    const Real qx = horn * h_sin - arm * (turn.sin * turn.slope);
    const Real qz = arm * (turn.cos * turn.slope) - horn * h_cos;
    const Real square = turn.slope * turn.slope;
    const Real ax = horn * h_cos - arm * (turn.cos * square);
    const Real az = horn * h_sin - arm * (turn.sin * square);
    turn.bend = -((qx * qx + qz * qz + px * ax + pz * az) / by_arm);
    return turn;
  }

  // The servo's angle that gives the arm this angle: (M55) with the bars exchanged.
  template <class Real>
  [[nodiscard]] Real horn_at(const Real& angle) const {
    const SinCos<Real> half = sin_cos(0.5 * angle);
    const Real vx = Real(x + arm) - (2 * arm) * (half.sin * half.sin);
    const Real vz = Real(z) + (2 * arm) * (half.sin * half.cos);
    const Real excess = Real(horn_excess) + (4 * arm) * (half.sin * (z * half.cos - x * half.sin));
    const Bar<Real> at = bar_to(vx, vz, excess, horn, horn_side);
    return horn_middle.angle_of(at.sin, at.cos);
  }
};

// The controller's model of the curve: none, because it commands the servo itself; the exact curve;
// or a line with the slope at home.
enum class Assumed { none, exact, ratio };

// The curve of one axis, from the servo's angle to the plane's.
struct LinkCurve {
  // Ideal: the plane's angle equals the servo's, without a linkage or with a parallelogram.
  enum class Kind { ideal, rods, table };
  Kind kind = Kind::ideal;
  Assumed assumed = Assumed::none;
  Rods rods{};
  // The present piece of a measured curve, for the servo and for its command.
  SplineView::Piece piece{}, command_piece{};
  double shift = 0;                         // subtracted from the curve to level home, rad
  double offset = 0;                        // of the plane, unknown to the controller, rad
  double cos_offset = 1, sin_offset = 0;    // of offset - shift
  double slope = 1;                         // at home
  double low = -HUGE_VAL, high = HUGE_VAL;  // range of servo angles with a solution, rad

  // Sets the offset of the plane and the shift of the curve.
  void set_offsets(double of_plane, double of_curve) {
    offset = of_plane;
    shift = of_curve;
    cos_offset = std::cos(offset - shift);
    sin_offset = std::sin(offset - shift);
  }

  template <class Real>
  static Turn<Real> along(const SplineView::Piece& p, const Real& servo, Real* value) {
    const Real s = servo - Real(p.start);
    *value = Real(p.c0) + s * (Real(p.c1) + s * (Real(p.c2) + p.c3 * s));
    const SinCos<Real> wave = sin_cos(*value);
    return {wave.sin, wave.cos, Real(p.c1) + s * (Real(2 * p.c2) + (3 * p.c3) * s),
            Real(2 * p.c2) + (6 * p.c3) * s};
  }

  // Without shift and offset.
  template <class Real>
  [[nodiscard]] Turn<Real> plain_turn(const Real& servo) const {
    if (kind == Kind::rods) return rods.arm_at(servo);
    if (kind == Kind::table) {
      Real value;
      return along(piece, servo, &value);
    }
    const SinCos<Real> wave = sin_cos(servo);
    return {wave.sin, wave.cos, Real(1.0), Real(0.0)};
  }

  // The plane's angle with shift and offset.
  template <class Real>
  [[nodiscard]] Turn<Real> turn(const Real& servo) const {
    const Turn<Real> plain = plain_turn(servo);
    return {cos_offset * plain.sin + sin_offset * plain.cos,
            cos_offset * plain.cos - sin_offset * plain.sin, plain.slope, plain.bend};
  }

  // The curve's angle without the plane's offset.
  template <class Real>
  [[nodiscard]] Real angle(const Real& servo) const {
    if (kind == Kind::ideal) return servo;
    Real value;
    if (kind == Kind::table) {
      along(piece, servo, &value);
    } else {
      const Turn<Real> turn = rods.arm_at(servo);
      value = rods.arm_middle.angle_of(turn.sin, turn.cos);
    }
    return value - Real(shift);
  }

  // The command to the servo for a plane angle that the controller wants.
  template <class Real>
  [[nodiscard]] Real command_for(const Real& wanted) const {
    if (assumed == Assumed::none || kind == Kind::ideal) return wanted;
    if (assumed == Assumed::ratio) return (1 / slope) * wanted;
    const Real angle = wanted + Real(shift);
    if (kind == Kind::rods) return rods.horn_at(angle);
    const SplineView::Piece& p = command_piece;
    Real servo = Real(p.start) + (1 / p.c1) * (angle - Real(p.c0));
    for (int i = 0; i < 6; ++i) {
      Real value;
      const Turn<Real> at = along(p, servo, &value);
      servo = servo - (value - angle) / at.slope;
    }
    return servo;
  }

  // The plane angle and rate that the controller infers from the servo's.
  template <class Real>
  void believed(const Real& servo, const Real& rate, Real* angle_there, Real* rate_there) const {
    if (assumed == Assumed::none || kind == Kind::ideal) {
      *angle_there = servo;
      *rate_there = rate;
    } else if (assumed == Assumed::ratio) {
      *angle_there = slope * servo;
      *rate_there = slope * rate;
    } else {
      *angle_there = angle(servo);
      *rate_there = plain_turn(servo).slope * rate;
    }
  }
};

// The linkages of both axes.
struct Linkages {
  static constexpr bool direct = false;
  static constexpr int servos = 2;
  LinkCurve of[2];

  // The plane's axes for these angles, rates and accelerations of the horns.
  template <class Real>
  void planes(const Real (&horn)[2], const Real (&rate)[2], const Real (&acceleration)[2],
              GimbalAngle<Real> (&axis)[2]) const {
    for (int i = 0; i < 2; ++i) {
      const Turn<Real> turn = of[i].turn(horn[i]);
      axis[i] = {turn.sin, turn.cos, turn.slope * rate[i],
                 turn.slope * acceleration[i] + turn.bend * (rate[i] * rate[i])};
    }
  }
  void angles(const double (&horn)[2], double (&plane)[2]) const {
    for (int i = 0; i < 2; ++i) plane[i] = of[i].angle(horn[i]) + of[i].offset;
  }
  template <class Real>
  void commands_for(const Real (&wanted)[2], Real (&servo)[2]) const {
    for (int i = 0; i < 2; ++i) servo[i] = of[i].command_for(wanted[i]);
  }
  template <class Real>
  void believed(const Real* servo, const Real* rate, Real (&angle)[2],
                Real (&angle_rate)[2]) const {
    for (int i = 0; i < 2; ++i) of[i].believed(servo[i], rate[i], &angle[i], &angle_rate[i]);
  }
  // The distance of the horns from the ends of the curves, rad; negative beyond them.
  [[nodiscard]] double margin(const double (&horn)[2]) const {
    double least = HUGE_VAL;
    for (int i = 0; i < 2; ++i) {
      least = std::fmin(least, std::fmin(horn[i] - of[i].low, of[i].high - horn[i]));
    }
    return least;
  }
};

}  // namespace bbsim::model
