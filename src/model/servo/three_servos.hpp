// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A plate on three legs, 3-RRS (docs/explanation/rig-model.md, "Three servos"). Each of three
// servos on a circle has a horn that turns in the vertical plane through the circle's center and
// the leg's joint, a rod, and a ball joint under the plate. The servos' angles determine two tilts
// and a height.
//
// Each joint stays in its plane. The plate's center therefore shifts, and the plate does not twist.
// The leg equations include both effects; the ball's motion ignores them.
#pragma once

#include <cmath>

#include "base/real.hpp"
#include "model/ball/rolling.hpp"
#include "model/servo/linkage.hpp"

namespace bbsim::model {

// A number with its first and second time derivative.
template <class Real>
struct Motion2 {
  Real v, d, dd;

  friend Motion2 operator+(const Motion2& a, const Motion2& b) {
    return {a.v + b.v, a.d + b.d, a.dd + b.dd};
  }
  friend Motion2 operator-(const Motion2& a, const Motion2& b) {
    return {a.v - b.v, a.d - b.d, a.dd - b.dd};
  }
  friend Motion2 operator*(const Motion2& a, const Motion2& b) {
    return {a.v * b.v, a.d * b.v + a.v * b.d, a.dd * b.v + 2.0 * (a.d * b.d) + a.v * b.dd};
  }
  friend Motion2 operator*(double a, const Motion2& b) { return {a * b.v, a * b.d, a * b.dd}; }
  friend Motion2 operator/(const Motion2& a, const Motion2& b) {
    const Real value = a.v / b.v, rate = (a.d - value * b.d) / b.v;
    return {value, rate, (a.dd - 2.0 * (rate * b.d) - value * b.dd) / b.v};
  }
  friend Motion2 root_along(const Motion2& square, const Motion2& along) {
    const Real value = root_along(square.v, along.v), rate = square.d / (2.0 * value);
    return {value, rate, (square.dd - 2.0 * (rate * rate)) / (2.0 * value)};
  }
};

struct ThreeServos {
  static constexpr bool direct = false;
  static constexpr int servos = 3;

  double base = 0, plate = 0;         // radii of the servo axes and of the joints, m
  double horn = 0, rod = 0;           // m
  double height = 0;                  // of the joints above the servo axes, at home, m
  double cos_home = 1, sin_home = 0;  // of the horns' elevation at home
  double side = 1;                    // of the leg on which the knee is
  Assumed assumed = Assumed::none;
  double slope[3][2] = {};  // derivatives of the servo angles by phi and theta, at home
  double cos_offset[2] = {1, 1}, sin_offset[2] = {0, 0}, offset[2] = {0, 0};  // of the plane, rad
  double determinant = 1;                                                     // at home

  // The plate's pose: its normal is (p, q, sqrt(1 - p^2 - q^2)), and the center of its joints is at
  // z.
  template <class T>
  struct Pose {
    T p, q, z;
  };

  // The position of leg i's joint in the leg's plane, from the servo's axis: (M58), (M59).
  template <class T>
  struct Joint {
    T x, z;
  };

  // The cosines and sines of the legs' azimuths, 0, 120 and 240 degrees, are constants in the code,
  // because kernels share no data.

  template <class T, class Number>
  [[nodiscard]] Joint<T> joint(int i, const Pose<T>& at, const Number& number) const {
    const double across = 0.8660254037844386;
    const double ex = i == 0 ? 1.0 : -0.5, ey = i == 0 ? 0.0 : i == 1 ? across : -across;
    const T pp = at.p * at.p, qq = at.q * at.q;
    const T one = number(1.0);
    const T w = one / (one + root_along(one - pp - qq, one));
    const T e = ex * at.p + ey * at.q;
    const T wander = w * ((0.5 * ex) * (qq - pp) + ey * (at.p * at.q));
    return {plate * (wander - w * (e * e)) + number(plate - base), at.z - plate * e};
  }

  // The rod's vector from the horn's end to the joint.
  template <class T>
  [[nodiscard]] Joint<T> rod_of(const Joint<T>& joint, const T& sine, const T& cosine) const {
    return {joint.x - horn * cosine, joint.z - horn * sine};
  }

  // Derivatives of half the rod's squared length with respect to p, q, z and to the horn's angle.
  template <class Real>
  struct Slopes {
    Real of[3], of_horn;
  };
  template <class Real>
  [[nodiscard]] Slopes<Real> slopes(int i, const Pose<Real>& at, const Real& sine,
                                    const Real& cosine) const {
    const double across = 0.8660254037844386;
    const double ex = i == 0 ? 1.0 : -0.5, ey = i == 0 ? 0.0 : i == 1 ? across : -across;
    const Real& p = at.p;
    const Real& q = at.q;
    const Real one = Real(1.0);
    const Real n = root_along(one - p * p - q * q, one), w = one / (one + n);
    const Real wn = w * w / n, wp = wn * p, wq = wn * q;
    const Real e = ex * p + ey * q;
    const Real form = (0.5 * ex) * (q * q - p * p) + ey * (p * q) - e * e;
    const Real form_p = ey * q - ex * p - (2 * ex) * e, form_q = ex * q + ey * p - (2 * ey) * e;
    const Joint<Real> leg =
        rod_of(joint(i, at, [](double value) { return Real(value); }), sine, cosine);
    return {{plate * (leg.x * (wp * form + w * form_p)) - (plate * ex) * leg.z,
             plate * (leg.x * (wq * form + w * form_q)) - (plate * ey) * leg.z, leg.z},
            horn * (leg.x * sine - leg.z * cosine)};
  }

  // Solves m x = right and returns m's determinant, by Cramer's rule.
  template <class Real>
  static Real solve(const Slopes<Real> (&m)[3], const Real (&right)[3], Real (&x)[3]) {
    const auto minor = [&](int i, int j, int k, int l) {
      return m[i].of[k] * m[j].of[l] - m[i].of[l] * m[j].of[k];
    };
    Real cofactor[3][3];
    for (int i = 0; i < 3; ++i) {
      const int a = (i + 1) % 3, b = (i + 2) % 3;
      for (int k = 0; k < 3; ++k) cofactor[i][k] = minor(a, b, (k + 1) % 3, (k + 2) % 3);
    }
    const Real whole =
        m[0].of[0] * cofactor[0][0] + m[0].of[1] * cofactor[0][1] + m[0].of[2] * cofactor[0][2];
    for (int k = 0; k < 3; ++k) {
      x[k] = (cofactor[0][k] * right[0] + cofactor[1][k] * right[1] + cofactor[2][k] * right[2]) /
             whole;
    }
    return whole;
  }

  template <class Real>
  void directions(const Real (&servo)[3], Real (&sine)[3], Real (&cosine)[3]) const {
    for (int i = 0; i < 3; ++i) {
      const SinCos<Real> at = sin_cos(servo[i]);
      sine[i] = cos_home * at.sin + sin_home * at.cos;
      cosine[i] = cos_home * at.cos - sin_home * at.sin;
    }
  }

  // Newton's iteration from home for the three leg equations, (M54) with (M59). The last steps
  // change nothing except near the edge of the workspace.
  template <class Real>
  [[nodiscard]] Pose<Real> pose(const Real (&sine)[3], const Real (&cosine)[3]) const {
    Pose<Real> at{Real(0.0), Real(0.0), Real(height)};
    for (int k = 0; k < 9; ++k) {
      Slopes<Real> m[3];
      Real right[3], step[3];
      for (int i = 0; i < 3; ++i) {
        m[i] = slopes(i, at, sine[i], cosine[i]);
        const Joint<Real> leg =
            rod_of(joint(i, at, [](double value) { return Real(value); }), sine[i], cosine[i]);
        right[i] = 0.5 * (leg.x * leg.x + leg.z * leg.z - Real(rod * rod));
      }
      solve(m, right, step);
      at.p = at.p - step[0];
      at.q = at.q - step[1];
      at.z = at.z - step[2];
    }
    return at;
  }

  // The plane's axes for these servo angles (from home), rates and accelerations.
  template <class Real>
  void planes(const Real (&servo)[3], const Real (&rate)[3], const Real (&acceleration)[3],
              Axis<Real> (&axis)[2]) const {
    Real sine[3], cosine[3];
    directions(servo, sine, cosine);
    const Pose<Real> at = pose(sine, cosine);
    Slopes<Real> m[3];
    Real right[3], first[3], second[3];
    for (int i = 0; i < 3; ++i) {
      m[i] = slopes(i, at, sine[i], cosine[i]);
      right[i] = -(m[i].of_horn * rate[i]);
    }
    solve(m, right, first);
    // The second derivative of the leg equations without the accelerations of p, q and z.
    const Real none = Real(0.0);
    const Pose<Motion2<Real>> moving{
        {at.p, first[0], none}, {at.q, first[1], none}, {at.z, first[2], none}};
    const auto constant = [](double value) {
      return Motion2<Real>{Real(value), Real(0.0), Real(0.0)};
    };
    for (int i = 0; i < 3; ++i) {
      const Real square = rate[i] * rate[i];
      const Motion2<Real> s{sine[i], cosine[i] * rate[i],
                            cosine[i] * acceleration[i] - sine[i] * square};
      const Motion2<Real> c{cosine[i], -(sine[i] * rate[i]),
                            -(sine[i] * acceleration[i]) - cosine[i] * square};
      const Joint<Motion2<Real>> leg = rod_of(joint(i, moving, constant), s, c);
      right[i] = -(0.5 * (leg.x * leg.x + leg.z * leg.z).dd);
    }
    solve(m, right, second);

    // sin theta = -q and sin phi = p / cos theta: (M61).
    const Motion2<Real> p{at.p, first[0], second[0]}, q{at.q, first[1], second[1]};
    const Motion2<Real> one = constant(1.0);
    const Motion2<Real> cos_theta = root_along(one - q * q, one);
    const Motion2<Real> sin_phi = p / cos_theta;
    put(0, sin_phi, root_along(one - sin_phi * sin_phi, one).v, axis[0]);
    put(1, {-q.v, -q.d, -q.dd}, cos_theta.v, axis[1]);
  }

  void angles(const double (&servo)[3], double (&plane)[2]) const {
    double sine[3], cosine[3];
    directions(servo, sine, cosine);
    const Pose<double> at = pose(sine, cosine);
    const double theta = std::asin(-at.q);
    plane[0] = std::asin(at.p / std::cos(theta)) + offset[0];
    plane[1] = theta + offset[1];
  }

  // The servo angles (from home) for these tilts at the height of home: (M60) and (M55).
  template <class Real>
  void told(const Real (&wanted)[2], Real (&servo)[3]) const {
    if (assumed == Assumed::ratio) {
      for (int i = 0; i < 3; ++i) servo[i] = slope[i][0] * wanted[0] + slope[i][1] * wanted[1];
      return;
    }
    const SinCos<Real> phi = sin_cos(wanted[0]), theta = sin_cos(wanted[1]);
    const Pose<Real> at{phi.sin * theta.cos, -theta.sin, Real(height)};
    for (int i = 0; i < 3; ++i) {
      const Joint<Real> to = joint(i, at, [](double value) { return Real(value); });
      const Real square = to.x * to.x + to.z * to.z;
      const Real k = (0.5 / horn) * (square + Real(horn * horn - rod * rod));
      const Real root = root_along(square - k * k, Real(side));
      const Real sine = (k * to.z + root * to.x) / square;
      const Real cosine = (k * to.x - root * to.z) / square;
      servo[i] = angle_of(Real(cos_home * sine - sin_home * cosine),
                          Real(cos_home * cosine + sin_home * sine));
    }
  }

  template <class Real>
  void believed(const Real* servo, const Real* rate, Real (&angle)[2],
                Real (&angle_rate)[2]) const {
    if (assumed == Assumed::ratio) {
      // The least-squares tilts. The two columns of slopes are orthogonal and of equal length.
      const double length =
          slope[0][0] * slope[0][0] + slope[1][0] * slope[1][0] + slope[2][0] * slope[2][0];
      for (int j = 0; j < 2; ++j) {
        angle[j] = angle_rate[j] = Real(0.0);
        for (int i = 0; i < 3; ++i) {
          angle[j] = angle[j] + (slope[i][j] / length) * servo[i];
          angle_rate[j] = angle_rate[j] + (slope[i][j] / length) * rate[i];
        }
      }
      return;
    }
    const Real at[3] = {servo[0], servo[1], servo[2]}, moving[3] = {rate[0], rate[1], rate[2]};
    const Real none[3] = {Real(0.0), Real(0.0), Real(0.0)};
    ThreeServos without = *this;
    without.cos_offset[0] = without.cos_offset[1] = 1;
    without.sin_offset[0] = without.sin_offset[1] = 0;
    Axis<Real> axis[2];
    without.planes(at, moving, none, axis);
    for (int j = 0; j < 2; ++j) {
      angle[j] = angle_of(axis[j].sin, axis[j].cos);
      angle_rate[j] = axis[j].rate;
    }
  }

  // The distance from the edge of the workspace: the least sine of the angles between horns and
  // rods, and the determinant over its value at home.
  [[nodiscard]] double margin(const double (&servo)[3]) const {
    double sine[3], cosine[3];
    directions(servo, sine, cosine);
    const Pose<double> at = pose(sine, cosine);
    Slopes<double> m[3];
    double none[3] = {0, 0, 0}, unused[3], least = HUGE_VAL;
    for (int i = 0; i < 3; ++i) {
      m[i] = slopes(i, at, sine[i], cosine[i]);
      least = std::fmin(least, side * m[i].of_horn / (horn * rod));
    }
    return std::fmin(least, solve(m, none, unused) / determinant);
  }

 private:
  template <class Real>
  void put(int i, const Motion2<Real>& sine, const Real& cosine, Axis<Real>& axis) const {
    axis.sin = cos_offset[i] * sine.v + sin_offset[i] * cosine;
    axis.cos = cos_offset[i] * cosine - sin_offset[i] * sine.v;
    axis.rate = sine.d / cosine;
    axis.acceleration = (sine.dd + sine.v * (axis.rate * axis.rate)) / cosine;
  }
};

}  // namespace bbsim::model
