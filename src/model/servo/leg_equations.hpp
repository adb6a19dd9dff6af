// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The equations of a plate on three legs: each rod has its length. They determine the plate's pose
// from the horns' angles, and its rates and accelerations from theirs
// (docs/explanation/rig-model.md, "Three servos").
#pragma once

#include <cmath>

#include "base/real.hpp"

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

// A number with its derivatives by p and by q.
template <class Real>
struct Slope2 {
  Real v, p, q;

  friend Slope2 operator+(const Slope2& a, const Slope2& b) {
    return {a.v + b.v, a.p + b.p, a.q + b.q};
  }
  friend Slope2 operator-(const Slope2& a, const Slope2& b) {
    return {a.v - b.v, a.p - b.p, a.q - b.q};
  }
  friend Slope2 operator*(const Slope2& a, const Slope2& b) {
    return {a.v * b.v, a.p * b.v + a.v * b.p, a.q * b.v + a.v * b.q};
  }
  friend Slope2 operator*(double a, const Slope2& b) { return {a * b.v, a * b.p, a * b.q}; }
  friend Slope2 operator/(const Slope2& a, const Slope2& b) {
    const Real value = a.v / b.v;
    return {value, (a.p - value * b.p) / b.v, (a.q - value * b.q) / b.v};
  }
  friend Slope2 root_along(const Slope2& square, const Slope2& along) {
    const Real value = root_along(square.v, along.v);
    return {value, square.p / (2.0 * value), square.q / (2.0 * value)};
  }
};

struct LegEquations {
  struct Leg {
    double base = 0, plate = 0;         // radii of the servo's axis and of the joint, m
    double horn = 0, rod = 0;           // m
    double height = 0;                  // of the joint above the servo's axis, at home, m
    double cos_zero = 1, sin_zero = 0;  // of the horn's elevation at the servo's zero
    double home = 0;                    // the horn's elevation at home, rad
    double level = 0;                   // the servo's angle at home, rad
    double turns = 1;                   // -1: the horn falls as the servo's angle grows
    double side = 1;                    // of the leg on which the knee lies
    // For unequal legs: the azimuth's cosine and sine, and the joint's height in the plate, m.
    double ex = 1, ey = 0, joint = 0;
    // Factors of the joints' distances from their planes without shift and twist. The sum with
    // `shift` is the shift along the leg; the twist makes the sum with `twist` vanish.
    double shift[3] = {}, twist = 0;
    double slope[2] = {};  // derivatives of the servo's angle by phi and theta, at home
  };
  Leg leg[3];
  bool equal = true;  // three alike at 0, 120 and 240 degrees

  // The plate's pose: its normal is (p, q, n) with n = sqrt(1 - p^2 - q^2), and its joints' center
  // is at z.
  template <class T>
  struct Pose {
    T p, q, z;
  };

  // The position of a leg's joint in the leg's plane, from the servo's axis: (M58), (M59).
  template <class T>
  struct Joint {
    T x, z;
  };

  // n, 1/n, w = 1/(1 + n), and -dw/dn over n. Roots and quotients take long, so they are shared.
  template <class Real>
  struct Third {
    Real n, inverse, w, w_slope;
  };
  template <class Real>
  [[nodiscard]] static Third<Real> third_of(const Real& p, const Real& q) {
    const Real one = Real(1.0), n = root_along(one - p * p - q * q, one);
    const Real both = one / (n * (one + n)), w = both * n;
    return {n, both * (one + n), w, both * w};
  }

  // Equal legs, at azimuths with the cosines and sines (ex, ey): the normal's component along each,
  // e = ex p + ey q, and (ex/2) (q^2 - p^2) + ey p q - e^2, whose product with w and the plate's
  // radius is the joint's way inward. These constants are in the code, because kernels share no
  // data.
  static constexpr double root_of_three = 1.7320508075688772, across = root_of_three / 2;
  template <class Real>
  static void components(const Real& p, const Real& q, Real (&e)[3]) {
    const Real half = -0.5 * p, beside = across * q;
    e[0] = p;
    e[1] = half + beside;
    e[2] = half - beside;
  }
  template <class Real>
  static void forms(const Real& p, const Real& q, Real (&form)[3]) {
    const Real mixed = root_of_three * p;
    form[0] = 0.5 * (q * q) - 1.5 * (p * p);
    form[1] = q * (mixed - q);
    form[2] = -(q * (mixed + q));
  }
  template <class Real>
  static void form_slopes(const Real& p, const Real& q, Real (&by_p)[3], Real (&by_q)[3]) {
    const Real mixed = root_of_three * p, twice = 2.0 * q;
    by_p[0] = -3.0 * p;
    by_p[1] = root_of_three * q;
    by_p[2] = -by_p[1];
    by_q[0] = q;
    by_q[1] = mixed - twice;
    by_q[2] = -(mixed + twice);
  }

  template <class Real>
  void joints(const Pose<Real>& at, Joint<Real> (&joint)[3]) const {
    if (!equal) {
      return unequal_joints(
          at, [](double value) { return Real(value); }, joint);
    }
    Real e[3], form[3];
    components(at.p, at.q, e);
    forms(at.p, at.q, form);
    const Real w = third_of(at.p, at.q).w;
    const double plate = leg[0].plate;
    for (int i = 0; i < 3; ++i) {
      joint[i] = {plate * (w * form[i]) + Real(plate - leg[0].base), at.z - plate * e[i]};
    }
  }

  // The twist of the plate about its normal by unequal legs, with intermediate results.
  template <class T>
  struct Twist {
    T n, w;        // the normal's third component, and 1/(1 + n)
    T e[3], f[3];  // the normal's components along and across the legs' planes
    T cosine, sine;
  };
  template <class T, class Number>
  [[nodiscard]] Twist<T> twist(const Pose<T>& at, const Number& number) const {
    const T one = number(1.0);
    const T n = root_along(one - at.p * at.p - at.q * at.q, one), w = one / (one + n);
    T e[3], f[3], a = number(0.0), b = number(0.0), c = number(0.0);
    for (int i = 0; i < 3; ++i) {
      const Leg& of = leg[i];
      e[i] = of.ex * at.p + of.ey * at.q;
      f[i] = of.ex * at.q - of.ey * at.p;
      a = a - (of.twist * of.plate) * (w * (e[i] * f[i]));
      b = b + (of.twist * of.plate) * (one - w * (f[i] * f[i]));
      c = c + (of.twist * of.joint) * f[i];
    }
    const T square = a * a + b * b, root = root_along(square - c * c, b);
    return {n,
            w,
            {e[0], e[1], e[2]},
            {f[0], f[1], f[2]},
            (b * root - a * c) / square,
            number(0.0) - (b * c + a * root) / square};
  }

  // (M66) to (M69).
  template <class T, class Number>
  void unequal_joints(const Pose<T>& at, const Number& number, Joint<T> (&joint)[3]) const {
    const T one = number(1.0);
    const auto [n, w, e, f, cosine, sine] = twist(at, number);
    T along[3], beside[3];  // the joint from the plate's center
    for (int i = 0; i < 3; ++i) {
      const Leg& of = leg[i];
      const T falls = of.plate * (cosine * e[i] + sine * f[i]);
      along[i] = of.plate * cosine - w * (e[i] * falls) + of.joint * e[i];
      beside[i] = of.plate * sine - w * (f[i] * falls) + of.joint * f[i];
      joint[i].z = at.z - falls + of.joint * (n - one) + number(of.height - leg[0].height);
    }
    for (int i = 0; i < 3; ++i) {
      const double* const shift = leg[i].shift;
      joint[i].x = along[i] - shift[0] * beside[0] - shift[1] * beside[1] - shift[2] * beside[2] -
                   number(leg[i].base);
    }
  }

  // A joint with its derivatives by p and q. z moves it up alone.
  template <class Real>
  struct Place {
    Joint<Real> at, by_p, by_q;
  };
  template <class Real>
  void places(const Pose<Real>& at, Place<Real> (&place)[3]) const {
    if (!equal) return unequal_places(at, place);
    Real e[3], form[3], by_p[3], by_q[3];
    components(at.p, at.q, e);
    forms(at.p, at.q, form);
    form_slopes(at.p, at.q, by_p, by_q);
    const Third<Real> third = third_of(at.p, at.q);
    const Real& w = third.w;
    const Real w_by_p = third.w_slope * at.p, w_by_q = third.w_slope * at.q;
    const double plate = leg[0].plate, ex[3] = {1, -0.5, -0.5}, ey[3] = {0, across, -across};
    for (int i = 0; i < 3; ++i) {
      place[i] = {
          {plate * (w * form[i]) + Real(plate - leg[0].base), at.z - plate * e[i]},
          {plate * (w_by_p * form[i] + w * by_p[i]), Real(-plate * ex[i])},
          {plate * (w_by_q * form[i] + w * by_q[i]), Real(-plate * ey[i])},
      };
    }
  }
  template <class Real>
  [[gnu::noinline]] void unequal_places(const Pose<Real>& at, Place<Real> (&place)[3]) const {
    const Real none = Real(0.0), one = Real(1.0);
    const auto constant = [&](double value) { return Slope2<Real>{Real(value), none, none}; };
    Joint<Slope2<Real>> joint[3];
    unequal_joints(Pose<Slope2<Real>>{{at.p, one, none}, {at.q, none, one}, {at.z, none, none}},
                   constant, joint);
    for (int i = 0; i < 3; ++i) {
      const auto& [x, z] = joint[i];
      place[i] = {{x.v, z.v}, {x.p, z.p}, {x.q, z.q}};
    }
  }

  // The joints' velocities at a rate of the pose, and their accelerations without one of the pose.
  template <class Real>
  void motions(const Pose<Real>& at, const Pose<Real>& rate, Joint<Real> (&velocity)[3],
               Joint<Real> (&acceleration)[3]) const {
    if (!equal) return unequal_motions(at, rate, velocity, acceleration);
    Real e[3], form[3], by_p[3], by_q[3], bent[3];
    components(rate.p, rate.q, e);
    forms(at.p, at.q, form);
    form_slopes(at.p, at.q, by_p, by_q);
    forms(rate.p, rate.q, bent);
    const Third<Real> third = third_of(at.p, at.q);
    const Real& w = third.w;
    const Real turned = at.p * rate.p + at.q * rate.q;
    const Real w_rate = third.w_slope * turned;
    const Real w_second = third.w_slope * (rate.p * rate.p + rate.q * rate.q) +
                          w_rate * turned * third.inverse * (2.0 * w + third.inverse);
    const double plate = leg[0].plate;
    for (int i = 0; i < 3; ++i) {
      const Real form_rate = by_p[i] * rate.p + by_q[i] * rate.q;
      velocity[i] = {plate * (w_rate * form[i] + w * form_rate), rate.z - plate * e[i]};
      acceleration[i] = {plate * (w_second * form[i] + 2.0 * (w_rate * form_rate + w * bent[i])),
                         Real(0.0)};
    }
  }
  template <class Real>
  [[gnu::noinline]] void unequal_motions(const Pose<Real>& at, const Pose<Real>& rate,
                                         Joint<Real> (&velocity)[3],
                                         Joint<Real> (&acceleration)[3]) const {
    const Real none = Real(0.0);
    const auto constant = [&](double value) { return Motion2<Real>{Real(value), none, none}; };
    Joint<Motion2<Real>> joint[3];
    unequal_joints(
        Pose<Motion2<Real>>{{at.p, rate.p, none}, {at.q, rate.q, none}, {at.z, rate.z, none}},
        constant, joint);
    for (int i = 0; i < 3; ++i) {
      velocity[i] = {joint[i].x.d, joint[i].z.d};
      acceleration[i] = {joint[i].x.dd, joint[i].z.dd};
    }
  }

  // The rod's vector from the horn's end to the joint, and the derivatives of half its squared
  // length with respect to p, q, z and to the horn's angle.
  template <class Real>
  struct Slopes {
    Real of[3], of_horn;
    Joint<Real> rod;
  };
  template <class Real>
  void slopes(const Pose<Real>& at, const Real (&sine)[3], const Real (&cosine)[3],
              Slopes<Real> (&m)[3]) const {
    Place<Real> place[3];
    places(at, place);
    for (int i = 0; i < 3; ++i) {
      const double horn = leg[i].horn;
      const Place<Real>& joint = place[i];
      const Joint<Real> rod{joint.at.x - horn * cosine[i], joint.at.z - horn * sine[i]};
      m[i] = {{rod.x * joint.by_p.x + rod.z * joint.by_p.z,
               rod.x * joint.by_q.x + rod.z * joint.by_q.z, rod.z},
              horn * (rod.x * sine[i] - rod.z * cosine[i]),
              rod};
    }
  }

  // The inverse of the slopes by p, q and z, and their determinant.
  template <class Real>
  struct Inverse {
    Real of[3][3], determinant;

    void times(const Real (&right)[3], Real (&x)[3]) const {
      for (int k = 0; k < 3; ++k) {
        x[k] = of[k][0] * right[0] + of[k][1] * right[1] + of[k][2] * right[2];
      }
    }
  };
  template <class Real>
  [[nodiscard]] static Inverse<Real> inverse_of(const Slopes<Real> (&m)[3]) {
    const auto minor = [&](int i, int j, int k, int l) {
      return m[i].of[k] * m[j].of[l] - m[i].of[l] * m[j].of[k];
    };
    Real cofactor[3][3];
    for (int i = 0; i < 3; ++i) {
      const int a = (i + 1) % 3, b = (i + 2) % 3;
      for (int k = 0; k < 3; ++k) cofactor[i][k] = minor(a, b, (k + 1) % 3, (k + 2) % 3);
    }
    Inverse<Real> inverse;
    inverse.determinant =
        m[0].of[0] * cofactor[0][0] + m[0].of[1] * cofactor[0][1] + m[0].of[2] * cofactor[0][2];
    const Real over = Real(1.0) / inverse.determinant;
    for (int k = 0; k < 3; ++k) {
      for (int i = 0; i < 3; ++i) inverse.of[k][i] = cofactor[i][k] * over;
    }
    return inverse;
  }

  // The leg equations linearized in a pose.
  template <class Real>
  struct Jacobian {
    Slopes<Real> of[3];
    Inverse<Real> inverse;
  };
  template <class Real>
  [[nodiscard]] Jacobian<Real> jacobian(const Pose<Real>& at, const Real (&sine)[3],
                                        const Real (&cosine)[3]) const {
    Jacobian<Real> there;
    slopes(at, sine, cosine, there.of);
    there.inverse = inverse_of(there.of);
    return there;
  }

  // The rates of p, q and z at these rates of the servos.
  template <class Real>
  [[nodiscard]] Pose<Real> pose_rate(const Jacobian<Real>& by, const Real (&rate)[3]) const {
    Real right[3], of[3];
    for (int i = 0; i < 3; ++i) right[i] = -(by.of[i].of_horn * (leg[i].turns * rate[i]));
    by.inverse.times(right, of);
    return {of[0], of[1], of[2]};
  }
  // Their accelerations: the leg equations differentiated twice.
  template <class Real>
  [[nodiscard]] Pose<Real> pose_acceleration(const Pose<Real>& at, const Pose<Real>& pose_rate,
                                             const Jacobian<Real>& by, const Real (&sine)[3],
                                             const Real (&cosine)[3], const Real (&rate)[3],
                                             const Real (&acceleration)[3]) const {
    Joint<Real> velocity[3], bend[3];
    motions(at, pose_rate, velocity, bend);
    Real right[3], of[3];
    for (int i = 0; i < 3; ++i) {
      const Joint<Real>& rod = by.of[i].rod;
      const Real turning = leg[i].horn * (leg[i].turns * rate[i]);
      const Real vx = velocity[i].x + sine[i] * turning, vz = velocity[i].z - cosine[i] * turning;
      const Real inward = leg[i].horn * (rate[i] * rate[i]);
      const Real ax = bend[i].x + cosine[i] * inward, az = bend[i].z + sine[i] * inward;
      right[i] = -(vx * vx + vz * vz + (rod.x * ax + rod.z * az) +
                   by.of[i].of_horn * (leg[i].turns * acceleration[i]));
    }
    by.inverse.times(right, of);
    return {of[0], of[1], of[2]};
  }

  // One step of Newton's iteration for the leg equations, (M54) with (M59), and the equations'
  // Jacobian before it. Returns the step's squared length, with z relative to the plate's radius.
  template <class Real>
  Real newton_step(const Real (&sine)[3], const Real (&cosine)[3], const Pose<Real>& at,
                   Pose<Real>& next, Jacobian<Real>& before) const {
    before = jacobian(at, sine, cosine);
    Real right[3], step[3];
    for (int i = 0; i < 3; ++i) {
      const Joint<Real>& rod = before.of[i].rod;
      right[i] = 0.5 * (rod.x * rod.x + rod.z * rod.z - Real(leg[i].rod * leg[i].rod));
    }
    before.inverse.times(right, step);
    next = {at.p - step[0], at.q - step[1], at.z - step[2]};
    const Real rise = (1 / leg[0].plate) * step[2];
    return step[0] * step[0] + step[1] * step[1] + rise * rise;
  }
};

}  // namespace bbsim::model
