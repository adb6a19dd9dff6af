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

struct ThreeServos {
  static constexpr bool direct = false;
  static constexpr int servos = 3;

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
  // The plate moves up to this determinant, relative to home's. In terms of a servo's angle, that
  // is about the square of it before the edge, rad.
  static constexpr double before_edge = 1e-4;
  Leg leg[3];
  bool equal = true;  // three alike at 0, 120 and 240 degrees
  Assumed assumed = Assumed::none;
  double inferred[2][3] = {};  // phi and theta from servo angles by the slopes at home
  double cos_offset[2] = {1, 1}, sin_offset[2] = {0, 0}, offset[2] = {0, 0};  // of the plane, rad
  double determinant = 1;                                                     // at home

  // The plate's pose: its normal is (p, q, sqrt(1 - p^2 - q^2)), and its joints' center is at z.
  template <class T>
  struct Pose {
    T p, q, z;
  };

  // The position of a leg's joint in the leg's plane, from the servo's axis: (M58), (M59).
  template <class T>
  struct Joint {
    T x, z;
  };

  // The cosines and sines of equal legs' azimuths are constants in the code, because kernels share
  // no data.

  template <class T, class Number>
  void joints(const Pose<T>& at, const Number& number, Joint<T> (&joint)[3]) const {
    if (!equal) return unequal_joints(at, number, joint);
    const double plate = leg[0].plate;
    for (int i = 0; i < 3; ++i) {
      const double across = 0.8660254037844386;
      const double ex = i == 0 ? 1.0 : -0.5, ey = i == 0 ? 0.0 : i == 1 ? across : -across;
      const T pp = at.p * at.p, qq = at.q * at.q;
      const T one = number(1.0);
      const T w = one / (one + root_along(one - pp - qq, one));
      const T e = ex * at.p + ey * at.q;
      const T wander = w * ((0.5 * ex) * (qq - pp) + ey * (at.p * at.q));
      joint[i] = {plate * (wander - w * (e * e)) + number(plate - leg[0].base), at.z - plate * e};
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

  // The rod's vector from the horn's end to the joint.
  template <class T>
  [[nodiscard]] Joint<T> rod_of(int i, const Joint<T>& joint, const T& sine,
                                const T& cosine) const {
    const double horn = leg[i].horn;
    return {joint.x - horn * cosine, joint.z - horn * sine};
  }

  // Derivatives of half the rod's squared length with respect to p, q, z and to the horn's angle.
  template <class Real>
  struct Slopes {
    Real of[3], of_horn;
  };
  template <class Real>
  void slopes(const Pose<Real>& at, const Real (&sine)[3], const Real (&cosine)[3],
              Slopes<Real> (&m)[3]) const {
    if (!equal) return unequal_slopes(at, sine, cosine, m);
    Joint<Real> joint[3];
    joints(
        at, [](double value) { return Real(value); }, joint);
    const double plate = leg[0].plate;
    for (int i = 0; i < 3; ++i) {
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
      const Joint<Real> rod = rod_of(i, joint[i], sine[i], cosine[i]);
      m[i] = {{plate * (rod.x * (wp * form + w * form_p)) - (plate * ex) * rod.z,
               plate * (rod.x * (wq * form + w * form_q)) - (plate * ey) * rod.z, rod.z},
              leg[0].horn * (rod.x * sine[i] - rod.z * cosine[i])};
    }
  }

  template <class Real>
  void unequal_slopes(const Pose<Real>& at, const Real (&sine)[3], const Real (&cosine)[3],
                      Slopes<Real> (&m)[3]) const {
    const Real none = Real(0.0), one = Real(1.0);
    const auto constant = [&](double value) { return Slope2<Real>{Real(value), none, none}; };
    Joint<Slope2<Real>> joint[3];
    unequal_joints(Pose<Slope2<Real>>{{at.p, one, none}, {at.q, none, one}, {at.z, none, none}},
                   constant, joint);
    for (int i = 0; i < 3; ++i) {
      const Joint<Real> rod = rod_of(i, {joint[i].x.v, joint[i].z.v}, sine[i], cosine[i]);
      m[i] = {{rod.x * joint[i].x.p + rod.z * joint[i].z.p,
               rod.x * joint[i].x.q + rod.z * joint[i].z.q, rod.z},
              leg[i].horn * (rod.x * sine[i] - rod.z * cosine[i])};
    }
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
      const Leg& of = leg[i];
      sine[i] = of.cos_zero * (of.turns * at.sin) + of.sin_zero * at.cos;
      cosine[i] = of.cos_zero * at.cos - of.sin_zero * (of.turns * at.sin);
    }
  }

  // One step of Newton's iteration for the three leg equations, (M54) with (M59). Returns the
  // step's squared length, with z relative to the plate's radius, and sets the determinant.
  template <class Real>
  Real newton_step(const Real (&sine)[3], const Real (&cosine)[3], const Pose<Real>& at,
                   Pose<Real>& next, Real& whole) const {
    Slopes<Real> m[3];
    Joint<Real> joint[3];
    Real right[3], step[3];
    slopes(at, sine, cosine, m);
    joints(
        at, [](double value) { return Real(value); }, joint);
    for (int i = 0; i < 3; ++i) {
      const Joint<Real> rod = rod_of(i, joint[i], sine[i], cosine[i]);
      right[i] = 0.5 * (rod.x * rod.x + rod.z * rod.z - Real(leg[i].rod * leg[i].rod));
    }
    whole = solve(m, right, step);
    next = {at.p - step[0], at.q - step[1], at.z - step[2]};
    const Real rise = (1 / leg[0].plate) * step[2];
    return step[0] * step[0] + step[1] * step[1] + rise * rise;
  }

  // Where Newton's iteration gets from the pose `known`, which belongs to the angles `from`, while
  // the servos go to their angles in equal parts: one step for each part but the last. From far
  // away the iteration may end in another solution.
  template <class Known, class Value>
  [[nodiscard]] Pose<Value> follow(const Pose<Known>& known, const Known (&from)[3],
                                   const Value (&servo)[3], int parts) const {
    Pose<Value> at{Value(known.p), Value(known.q), Value(known.z)}, next;
    Value between[3], sine[3], cosine[3], whole;
    for (int k = 1; k < parts; ++k) {
      const double part = static_cast<double>(k) / parts;
      for (int i = 0; i < 3; ++i) {
        between[i] = part * servo[i] + Value((1 - part) * from[i]);
      }
      directions(between, sine, cosine);
      newton_step(sine, cosine, at, next, whole);
      at = next;
    }
    return at;
  }
  // The number of parts for servos that move this far, rad.
  static constexpr int most_parts = 64;
  [[nodiscard]] static int parts_for(double motion) {
    constexpr double far = 0.25;
    return motion < most_parts * far ? 1 + static_cast<int>(motion / far) : most_parts;
  }

  // The pose in these directions of the horns near a pose. Newton's iteration goes on until its
  // steps are small, which takes many only near the edge of the workspace. This needs no
  // derivatives. The last steps square the error, and provide them. `determinant_near` becomes that
  // of the leg equations before the last step.
  //
  // With the determinant d over that at home, a step L leaves an error of some (5 / d) L^2. A last
  // step after L^2 <= 1e-9 d^2 therefore leaves 125 / d^3 L^4, which is below rounding.
  template <class Real, class Value>
  [[nodiscard]] Pose<Real> pose_near(Pose<Value> at, const Real (&sine)[3], const Real (&cosine)[3],
                                     Real* determinant_near = nullptr) const {
    constexpr int most_steps = 40, last_steps = std::is_same_v<Real, Value> ? 1 : 2;
    constexpr double small = 1e-9;
    Pose<Value> next;
    Value s[3], c[3], whole;
    for (int i = 0; i < 3; ++i) {
      s[i] = value_of(sine[i]);
      c[i] = value_of(cosine[i]);
    }
    auto goes_on = exceeds(Value(1.0), Value(0.0));
    for (int k = 0; k < most_steps; ++k) {
      const Value square = newton_step(s, c, at, next, whole);
      // A lane that has arrived waits for the others, so that its result does not depend on them.
      at = {choose(goes_on, next.p, at.p), choose(goes_on, next.q, at.q),
            choose(goes_on, next.z, at.z)};
      const Value inverse = Value(1.0) / whole;
      const Value left = (determinant * determinant) * square * inverse * inverse;
      goes_on = goes_on & exceeds(left, Value(small));
      if (!(largest_of(left) > small)) break;
    }
    Pose<Real> pose{Real(at.p), Real(at.q), Real(at.z)}, better;
    Real determinant_there;
    for (int k = 0; k < last_steps; ++k) {
      newton_step(sine, cosine, pose, better, determinant_there);
      pose = better;
    }
    if (determinant_near != nullptr) *determinant_near = determinant_there;
    return pose;
  }

  // The pose at the angles `servo`, followed from the pose `known` at the angles `from`. At the
  // edge of the workspace two poses meet, whose determinants differ in sign. Near it Newton's
  // iteration may get to the other pose; the way is then cut into more parts.
  [[nodiscard]] Pose<double> pose_from(const Pose<double>& known, const double (&from)[3],
                                       const double (&servo)[3], const double (&sine)[3],
                                       const double (&cosine)[3]) const {
    double moved = 0;
    for (int i = 0; i < 3; ++i) moved = std::fmax(moved, std::abs(servo[i] - from[i]));
    for (int parts = parts_for(moved);; parts *= 8) {
      double determinant_near;
      const Pose<double> at =
          pose_near(follow(known, from, servo, parts), sine, cosine, &determinant_near);
      if (determinant_near * determinant > 0 || parts >= most_parts) return at;
    }
  }

  // The pose at home, and the servos' angles there, rad.
  [[nodiscard]] Pose<double> home(double (&servo)[3]) const {
    for (int i = 0; i < 3; ++i) servo[i] = leg[i].level;
    return {0, 0, leg[0].height};
  }

  // The pose at these servo angles, followed from home.
  template <class Real>
  [[nodiscard]] Pose<Real> pose(const Real (&servo)[3], const Real (&sine)[3],
                                const Real (&cosine)[3]) const {
    using Value = std::decay_t<decltype(value_of(servo[0]))>;
    constexpr int parts = 4;
    const Value to[3] = {value_of(servo[0]), value_of(servo[1]), value_of(servo[2])};
    double from[3];
    const Pose<double> known = home(from);
    if constexpr (std::is_same_v<Real, double>) {
      return pose_from(known, from, servo, sine, cosine);
    } else {
      return pose_near(follow(known, from, to, parts), sine, cosine);
    }
  }

  // The derivatives of p, q and z by the servos' angles, from the slopes() in a pose.
  void pose_slopes(const Slopes<double> (&m)[3], double (&by)[3][3]) const {
    for (int i = 0; i < 3; ++i) {
      double right[3] = {}, moved[3];
      right[i] = -(m[i].of_horn * leg[i].turns);
      solve(m, right, moved);
      for (int k = 0; k < 3; ++k) by[k][i] = moved[k];
    }
  }

  // How far the servos are from the edge of the workspace in a pose: the determinant over its value
  // at home, less `before_edge`, and the sines of the angles between horns and rods.
  static constexpr int edge_count = 4;
  template <class Real>
  void edges(const Pose<Real>& at, const Real (&sine)[3], const Real (&cosine)[3],
             const Real& determinant_there, Real* into) const {
    Joint<Real> joint[3];
    joints(
        at, [](double value) { return Real(value); }, joint);
    into[0] = (1 / determinant) * determinant_there - Real(before_edge);
    for (int i = 0; i < 3; ++i) {
      const Joint<Real> rod = rod_of(i, joint[i], sine[i], cosine[i]);
      into[1 + i] = (leg[i].side / leg[i].rod) * (rod.x * sine[i] - rod.z * cosine[i]);
    }
  }

  // The plane's axes for these servo angles (from home), rates and accelerations.
  template <class Real>
  void planes(const Real (&servo)[3], const Real (&rate)[3], const Real (&acceleration)[3],
              GimbalAngle<Real> (&axis)[2]) const {
    Real sine[3], cosine[3];
    directions(servo, sine, cosine);
    planes_in(pose(servo, sine, cosine), sine, cosine, rate, acceleration, axis);
  }

  // The same in a pose that is known. Returns the determinant of the leg equations.
  template <class Real>
  Real planes_in(const Pose<Real>& at, const Real (&sine)[3], const Real (&cosine)[3],
                 const Real (&rate)[3], const Real (&acceleration)[3],
                 GimbalAngle<Real> (&axis)[2]) const {
    Slopes<Real> m[3];
    slopes(at, sine, cosine, m);
    return planes_in(at, m, sine, cosine, rate, acceleration, axis);
  }
  // The same with the slopes() in the pose.
  template <class Real>
  Real planes_in(const Pose<Real>& at, const Slopes<Real> (&m)[3], const Real (&sine)[3],
                 const Real (&cosine)[3], const Real (&rate)[3], const Real (&acceleration)[3],
                 GimbalAngle<Real> (&axis)[2]) const {
    Real right[3], first[3], second[3];
    for (int i = 0; i < 3; ++i) right[i] = -(m[i].of_horn * (leg[i].turns * rate[i]));
    const Real whole = solve(m, right, first);
    // The second derivative of the leg equations without the accelerations of p, q and z.
    const Real none = Real(0.0);
    const Pose<Motion2<Real>> moving{
        {at.p, first[0], none}, {at.q, first[1], none}, {at.z, first[2], none}};
    const auto constant = [](double value) {
      return Motion2<Real>{Real(value), Real(0.0), Real(0.0)};
    };
    Joint<Motion2<Real>> joint[3];
    joints(moving, constant, joint);
    for (int i = 0; i < 3; ++i) {
      const Real square = rate[i] * rate[i];
      const Real turning = leg[i].turns * rate[i], pushing = leg[i].turns * acceleration[i];
      const Motion2<Real> s{sine[i], cosine[i] * turning, cosine[i] * pushing - sine[i] * square};
      const Motion2<Real> c{cosine[i], -(sine[i] * turning),
                            -(sine[i] * pushing) - cosine[i] * square};
      const Joint<Motion2<Real>> rod = rod_of(i, joint[i], s, c);
      right[i] = -(0.5 * (rod.x * rod.x + rod.z * rod.z).dd);
    }
    solve(m, right, second);

    // sin theta = -q and sin phi = p / cos theta: (M61).
    const Motion2<Real> p{at.p, first[0], second[0]}, q{at.q, first[1], second[1]};
    const Motion2<Real> one = constant(1.0);
    const Motion2<Real> cos_theta = root_along(one - q * q, one);
    const Motion2<Real> sin_phi = p / cos_theta;
    put(0, sin_phi, root_along(one - sin_phi * sin_phi, one).v, axis[0]);
    put(1, {-q.v, -q.d, -q.dd}, cos_theta.v, axis[1]);
    return whole;
  }

  // The servo angles (from home) for these tilts at the height of home: (M60) and (M55).
  template <class Real>
  void told(const Real (&wanted)[2], Real (&servo)[3]) const {
    if (assumed == Assumed::ratio) {
      for (int i = 0; i < 3; ++i) {
        servo[i] = leg[i].slope[0] * wanted[0] + leg[i].slope[1] * wanted[1];
      }
      return;
    }
    const SinCos<Real> phi = sin_cos(wanted[0]), theta = sin_cos(wanted[1]);
    const Pose<Real> at{phi.sin * theta.cos, -theta.sin, Real(leg[0].height)};
    Joint<Real> joint[3];
    joints(
        at, [](double value) { return Real(value); }, joint);
    for (int i = 0; i < 3; ++i) {
      const Leg& of = leg[i];
      const Joint<Real>& to = joint[i];
      const Real square = to.x * to.x + to.z * to.z;
      const Real k = (0.5 / of.horn) * (square + Real(of.horn * of.horn - of.rod * of.rod));
      const Real root = root_along(square - k * k, Real(of.side));
      const Real sine = (k * to.z + root * to.x) / square;
      const Real cosine = (k * to.x - root * to.z) / square;
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
    double sine[3], cosine[3], whole = 0;
    directions(servo, sine, cosine);
    const Pose<double> at = pose(servo, sine, cosine);
    Pose<double> next;
    if (!(newton_step(sine, cosine, at, next, whole) < 1e-12)) return -1;
    double margins[edge_count];
    edges(at, sine, cosine, whole, margins);
    return std::fmin(std::fmin(margins[0], margins[1]), std::fmin(margins[2], margins[3]));
  }

 private:
  template <class Real>
  void put(int i, const Motion2<Real>& sine, const Real& cosine, GimbalAngle<Real>& axis) const {
    axis.sin = cos_offset[i] * sine.v + sin_offset[i] * cosine;
    axis.cos = cos_offset[i] * cosine - sin_offset[i] * sine.v;
    axis.rate = sine.d / cosine;
    axis.acceleration = (sine.dd + sine.v * (axis.rate * axis.rate)) / cosine;
  }
};

}  // namespace bbsim::model
