// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A plate on three legs, 3-RRS (docs/explanation/rig-model.md, "Three servos"). Each of three
// servos has a horn that turns in the vertical plane through the plate's center and the leg's
// joint, a rod, and a ball joint under the plate. The servos' angles determine two tilts and a
// height.
//
// Each joint stays in its plane. The plate's center therefore shifts, and unequal legs twist the
// plate. The leg equations include both effects; the ball's motion ignores them.
#pragma once

#include <cmath>
#include <type_traits>

#include "base/real.hpp"
#include "model/ball/rolling.hpp"
#include "model/servo/leg_equations.hpp"
#include "model/servo/linkage.hpp"

namespace bbsim::model {

struct ThreeServos : LegEquations {
  static constexpr bool direct = false;
  static constexpr int servos = 3;

  // The plate moves up to this determinant, relative to home's. In terms of a servo's angle, that
  // is about the square of it before the edge, rad.
  static constexpr double before_edge = 1e-4;
  Assumed assumed = Assumed::none;
  double inferred[2][3] = {};  // phi and theta from servo angles by the slopes at home
  double cos_offset[2] = {1, 1}, sin_offset[2] = {0, 0}, offset[2] = {0, 0};  // of the plane, rad
  double determinant = 1;                                                     // at home
  // The first and second derivatives of p, q and z by the servos' angles, at home.
  double home_slopes[3][3] = {}, home_bends[3][3][3] = {};

  void set_offset(int axis, double angle) {
    offset[axis] = angle;
    cos_offset[axis] = std::cos(angle);
    sin_offset[axis] = std::sin(angle);
  }

  // The directions of the horns at these servo angles. wave(angle) gives sine and cosine.
  template <class Real, class Wave>
  void directions(const Real (&servo)[3], Real (&sine)[3], Real (&cosine)[3], Wave wave) const {
    for (int i = 0; i < 3; ++i) {
      const SinCos<Real> at = wave(servo[i]);
      const Leg& of = leg[i];
      sine[i] = of.cos_zero * (of.turns * at.sin) + of.sin_zero * at.cos;
      cosine[i] = of.cos_zero * at.cos - of.sin_zero * (of.turns * at.sin);
    }
  }
  template <class Real>
  void directions(const Real (&servo)[3], Real (&sine)[3], Real (&cosine)[3]) const {
    directions(servo, sine, cosine, [](const Real& angle) { return sin_cos(angle); });
  }

  // Where Newton's iteration gets from the pose `known`, which belongs to the angles `from`, while
  // the servos go to their angles in equal parts: one step for each part but the last. From far
  // away the iteration may end in another solution.
  template <class Known, class Value>
  [[nodiscard]] Pose<Value> follow(const Pose<Known>& known, const Known (&from)[3],
                                   const Value (&servo)[3], int parts) const {
    Pose<Value> at{Value(known.p), Value(known.q), Value(known.z)}, next;
    Value between[3], sine[3], cosine[3];
    Jacobian<Value> before;
    for (int k = 1; k < parts; ++k) {
      const double part = static_cast<double>(k) / parts;
      for (int i = 0; i < 3; ++i) {
        between[i] = part * servo[i] + Value((1 - part) * from[i]);
      }
      directions(between, sine, cosine);
      newton_step(sine, cosine, at, next, before);
      at = next;
    }
    return at;
  }
  [[nodiscard]] static double largest_size(const double (&moved)[3]) {
    return std::fmax(std::fmax(std::abs(moved[0]), std::abs(moved[1])), std::abs(moved[2]));
  }
  // The number of parts for servos that move this far, rad.
  static constexpr int most_parts = 64;
  [[nodiscard]] static int parts_for(double motion) {
    constexpr double far = 0.25;
    return motion < most_parts * far ? 1 + static_cast<int>(motion / far) : most_parts;
  }

  // The pose in these directions of the horns near a pose, and the leg equations' Jacobian there.
  // Newton's iteration goes on until its steps are small, which takes many only near the edge of
  // the workspace. This needs no derivatives. The last steps square the error, and provide them.
  //
  // With the determinant d over that at home, a step L leaves an error of some (5 / d) L^2. A last
  // step after L^2 <= 1e-9 d^2 therefore leaves 125 / d^3 L^4, which is below rounding.
  template <class Real, class Value>
  [[nodiscard]] Pose<Real> pose_near(Pose<Value> at, const Real (&sine)[3], const Real (&cosine)[3],
                                     Jacobian<Real>& there) const {
    constexpr bool plain = std::is_same_v<Real, Value>;
    constexpr int most_steps = 40, last_steps = plain ? 1 : 2;
    constexpr double small = 1e-9, negligible = 1e-26;
    Pose<Value> next;
    Value s[3], c[3];
    for (int i = 0; i < 3; ++i) {
      s[i] = value_of(sine[i]);
      c[i] = value_of(cosine[i]);
    }
    // How far a step's squared length is beyond a limit, which shrinks with the determinant.
    const auto beyond = [this](double limit, const Value& square, const Value& whole) {
      return (determinant * determinant) * square - limit * (whole * whole);
    };
    auto goes_on = exceeds(Value(1.0), Value(0.0));
    for (int k = 0; k < most_steps; ++k) {
      Jacobian<Value> before;
      const Value square = newton_step(s, c, at, next, before);
      // A lane that has arrived waits for the others, so that its result does not depend on them.
      at = {choose(goes_on, next.p, at.p), choose(goes_on, next.q, at.q),
            choose(goes_on, next.z, at.z)};
      const Value left = beyond(small, square, before.inverse.determinant);
      goes_on = goes_on & exceeds(left, Value(0.0));
      if (!(largest_of(left) > 0)) break;
    }
    Pose<Real> pose{Real(at.p), Real(at.q), Real(at.z)}, better;
    Value square;
    for (int k = 0; k < last_steps; ++k) {
      square = value_of(newton_step(sine, cosine, pose, better, there));
      pose = better;
    }
    // Usually the last step is so short that it does not change the Jacobian. All lanes take it
    // again if one must, so its last digits, unlike the pose's, may depend on the other lanes.
    if (!plain ||
        !(largest_of(beyond(negligible, square, value_of(there.inverse.determinant))) <= 0)) {
      there = jacobian(pose, sine, cosine);
    }
    return pose;
  }

  // The pose at the angles `servo`, followed from the pose `known` at the angles `from`. At the
  // edge of the workspace two poses meet, whose determinants differ in sign. Near it Newton's
  // iteration may get to the other pose; the way is then cut into more parts.
  [[nodiscard]] Pose<double> pose_from(const Pose<double>& known, const double (&from)[3],
                                       const double (&servo)[3], const double (&sine)[3],
                                       const double (&cosine)[3], Jacobian<double>& there) const {
    const double moved[3] = {servo[0] - from[0], servo[1] - from[1], servo[2] - from[2]};
    for (int parts = parts_for(largest_size(moved));; parts *= 8) {
      const Pose<double> at = pose_near(follow(known, from, servo, parts), sine, cosine, there);
      if (there.inverse.determinant * determinant > 0 || parts >= most_parts) return at;
    }
  }

  // The pose at home, and the servos' angles there, rad.
  [[nodiscard]] Pose<double> home(double (&servo)[3]) const {
    for (int i = 0; i < 3; ++i) servo[i] = leg[i].level;
    return {0, 0, leg[0].height};
  }

  // The pose near home by its Taylor polynomial of second order.
  [[nodiscard]] Pose<double> pose_by_series(const double (&moved)[3]) const {
    double at[3];
    for (int k = 0; k < 3; ++k) {
      at[k] = 0;
      for (int i = 0; i < 3; ++i) {
        const double* const bend = home_bends[k][i];
        const double bent = bend[0] * moved[0] + bend[1] * moved[1] + bend[2] * moved[2];
        at[k] += moved[i] * (home_slopes[k][i] + 0.5 * bent);
      }
    }
    return {at[0], at[1], leg[0].height + at[2]};
  }

  // The pose at these servo angles, followed from home.
  template <class Real>
  [[nodiscard]] Pose<Real> pose(const Real (&servo)[3], const Real (&sine)[3],
                                const Real (&cosine)[3], Jacobian<Real>& there) const {
    using Value = std::decay_t<decltype(value_of(servo[0]))>;
    constexpr int parts = 4;
    const Value to[3] = {value_of(servo[0]), value_of(servo[1]), value_of(servo[2])};
    double from[3];
    const Pose<double> known = home(from);
    if constexpr (std::is_same_v<Real, double>) {
      const double moved[3] = {servo[0] - from[0], servo[1] - from[1], servo[2] - from[2]};
      if (parts_for(largest_size(moved)) == 1) {
        const Pose<double> at = pose_near(pose_by_series(moved), sine, cosine, there);
        if (there.inverse.determinant * determinant > 0) return at;
      }
      return pose_from(known, from, servo, sine, cosine, there);
    } else {
      return pose_near(follow(known, from, to, parts), sine, cosine, there);
    }
  }

  // The derivatives of p, q and z by the servos' angles.
  template <class Real>
  void pose_slopes(const Jacobian<Real>& there, Real (&by)[3][3]) const {
    for (int i = 0; i < 3; ++i) {
      const Real horn = leg[i].turns * there.of[i].of_horn;
      for (int k = 0; k < 3; ++k) by[k][i] = -(there.inverse.of[k][i] * horn);
    }
  }

  // The rates of phi and theta in a pose with these slopes, at rates of the servos.
  void tilt_rates(const Pose<double>& at, const double (&by)[3][3], const double (&rate)[3],
                  double (&of)[2]) const {
    const auto sum = [&](int k) {
      return by[k][0] * rate[0] + by[k][1] * rate[1] + by[k][2] * rate[2];
    };
    // cos(theta) phi' = (p' + sin(phi) sin(theta) theta') / cos(phi), with one quotient for both.
    const double square = 1 - at.q * at.q, root = std::sqrt(square);
    const double n = std::sqrt(square - at.p * at.p), over = 1 / (square * n);
    of[0] = (sum(0) * square + at.p * at.q * sum(1)) * over;
    of[1] = -sum(1) * (root * n * over);
  }

  // How far the servos are from the edge of the workspace in a pose: the determinant over its value
  // at home, less `before_edge`, and the sines of the angles between horns and rods.
  static constexpr int edge_count = 4;
  template <class Real>
  void edges(const Jacobian<Real>& there, Real* into) const {
    into[0] = (1 / determinant) * there.inverse.determinant - Real(before_edge);
    for (int i = 0; i < 3; ++i) {
      into[1 + i] = (leg[i].side / (leg[i].rod * leg[i].horn)) * there.of[i].of_horn;
    }
  }

  // The plane's axes for these servo angles (from home), rates and accelerations.
  template <class Real>
  void planes(const Real (&servo)[3], const Real (&rate)[3], const Real (&acceleration)[3],
              GimbalAngle<Real> (&axis)[2]) const {
    Real sine[3], cosine[3];
    directions(servo, sine, cosine);
    Jacobian<Real> there;
    const Pose<Real> at = pose(servo, sine, cosine, there);
    planes_in(at, there, sine, cosine, rate, acceleration, axis);
  }

  // The same in a pose that is known, with its jacobian().
  template <class Real>
  void planes_in(const Pose<Real>& at, const Jacobian<Real>& there, const Real (&sine)[3],
                 const Real (&cosine)[3], const Real (&rate)[3], const Real (&acceleration)[3],
                 GimbalAngle<Real> (&axis)[2]) const {
    const Pose<Real> first = pose_rate(there, rate);
    const Pose<Real> second = pose_acceleration(at, first, there, sine, cosine, rate, acceleration);
    // sin theta = -q and sin phi = p / cos theta, (M61), so cos phi cos theta = n.
    const Real one = Real(1.0);
    const Real cos_theta = root_along(one - at.q * at.q, one), over_theta = one / cos_theta;
    const Third<Real> third = third_of(at.p, at.q);
    const Real sin_theta = -at.q, sin_phi = at.p * over_theta, cos_phi = third.n * over_theta;
    const Real theta_rate = -(first.q * over_theta);
    const Real phi_rate = (first.p + sin_phi * sin_theta * theta_rate) * third.inverse;
    const Real theta_square = theta_rate * theta_rate;
    const Real theta_second = (sin_theta * theta_square - second.q) * over_theta;
    const Real phi_second =
        (second.p +
         sin_theta * (2.0 * (cos_phi * (phi_rate * theta_rate)) + sin_phi * theta_second) +
         at.p * (theta_square + phi_rate * phi_rate)) *
        third.inverse;
    put(0, sin_phi, cos_phi, axis[0]);
    put(1, sin_theta, cos_theta, axis[1]);
    axis[0].rate = phi_rate;
    axis[0].acceleration = phi_second;
    axis[1].rate = theta_rate;
    axis[1].acceleration = theta_second;
  }

  // The servo angles (from home) for these tilts at the height of home: (M60) and (M55).
  template <class Real>
  void commands_for(const Real (&wanted)[2], Real (&servo)[3]) const {
    if (assumed == Assumed::ratio) {
      for (int i = 0; i < 3; ++i) {
        servo[i] = leg[i].slope[0] * wanted[0] + leg[i].slope[1] * wanted[1];
      }
      return;
    }
    const SinCos<Real> phi = sin_cos(wanted[0]), theta = sin_cos(wanted[1]);
    const Pose<Real> at{phi.sin * theta.cos, -theta.sin, Real(leg[0].height)};
    Joint<Real> joint[3];
    joints(at, joint);
    for (int i = 0; i < 3; ++i) {
      const Leg& of = leg[i];
      const Joint<Real>& to = joint[i];
      const Real square = to.x * to.x + to.z * to.z;
      // (M55), times 2 horn.
      const double twice = 2 * of.horn;
      const Real k = square + Real(of.horn * of.horn - of.rod * of.rod);
      const Real root = root_along((twice * twice) * square - k * k, Real(of.side));
      const Real over = Real(1.0) / (twice * square);
      const Real sine = over * (k * to.z + root * to.x), cosine = over * (k * to.x - root * to.z);
      servo[i] = of.turns * angle_of(Real(of.cos_zero * sine - of.sin_zero * cosine),
                                     Real(of.cos_zero * cosine + of.sin_zero * sine));
    }
  }

  template <class Real>
  void believed(const Real* servo, const Real* rate, Real (&angle)[2],
                Real (&angle_rate)[2]) const {
    if (assumed == Assumed::ratio) {
      for (int j = 0; j < 2; ++j) {
        angle[j] = angle_rate[j] = Real(0.0);
        for (int i = 0; i < 3; ++i) {
          angle[j] = angle[j] + inferred[j][i] * servo[i];
          angle_rate[j] = angle_rate[j] + inferred[j][i] * rate[i];
        }
      }
      return;
    }
    const Real at[3] = {servo[0], servo[1], servo[2]}, moving[3] = {rate[0], rate[1], rate[2]};
    const Real none[3] = {Real(0.0), Real(0.0), Real(0.0)};
    ThreeServos without = *this;
    without.cos_offset[0] = without.cos_offset[1] = 1;
    without.sin_offset[0] = without.sin_offset[1] = 0;
    GimbalAngle<Real> axis[2];
    without.planes(at, moving, none, axis);
    for (int j = 0; j < 2; ++j) {
      angle[j] = angle_of(axis[j].sin, axis[j].cos);
      angle_rate[j] = axis[j].rate;
    }
  }

  // The least of the edges(); -1 beyond the edge, where no pose fits the servos' angles. Where the
  // determinant is zero, the plate's rate is infinite.
  [[nodiscard]] double margin(const double (&servo)[3]) const {
    double sine[3], cosine[3], margins[edge_count];
    directions(servo, sine, cosine);
    Jacobian<double> there;
    const Pose<double> at = pose(servo, sine, cosine, there);
    Pose<double> next;
    if (!(newton_step(sine, cosine, at, next, there) < 1e-12)) return -1;
    edges(there, margins);
    return std::fmin(std::fmin(margins[0], margins[1]), std::fmin(margins[2], margins[3]));
  }

 private:
  // An axis of the plane, turned by its offset.
  template <class Real>
  void put(int i, const Real& sine, const Real& cosine, GimbalAngle<Real>& axis) const {
    axis.sin = cos_offset[i] * sine + sin_offset[i] * cosine;
    axis.cos = cos_offset[i] * cosine - sin_offset[i] * sine;
  }
};

}  // namespace bbsim::model
