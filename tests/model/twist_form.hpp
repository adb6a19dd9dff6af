// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The paper's own derivation, equations (2)-(26), evaluated numerically: twists, the 6x6 inertia
// and the pairing with s3, s4, s5. Shares only the meaning of the symbols with src/model.
#pragma once

#include <Eigen/Dense>

namespace twist_form {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

struct State {
  double x, y, x_dot, y_dot, gamma_dot;
  double phi, theta, phi_dot, theta_dot, phi_ddot, theta_ddot;
};

// A rig that may differ from the paper's: the ball's moment of inertia over m r^2, the plane's
// height above the gimbal's center, and axis errors (docs/explanation/model.md, (M15)).
struct Rig {
  double k = 0.4, height = 0, skew = 0, yaw = 0, base_tilt = 0;
};

inline Matrix3d ad(const Vector3d& v) {
  Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

inline Vector6 stack(const Vector3d& top, const Vector3d& bottom) {
  Vector6 v;
  v << top, bottom;
  return v;
}

// (x'', y'', gamma'') from N s' + {s, N s} = G - R, equation (21), paired with s3, s4 and s5.
inline Vector3d accelerations(const State& q, double r, double m, double g, const Rig& rig = {}) {
  const Vector3d i = Vector3d::UnitX(), k = Vector3d::UnitZ();
  const auto about_z = [&](double angle) { return Eigen::AngleAxisd(angle, k).toRotationMatrix(); };
  const Matrix3d base = Eigen::AngleAxisd(rig.base_tilt, i).toRotationMatrix();
  const Vector3d j = base * Vector3d::UnitY();
  const Matrix3d rotate_phi =
      base * Eigen::AngleAxisd(q.phi, Vector3d::UnitY()).toRotationMatrix() * about_z(rig.skew);
  const Matrix3d rotate =
      rotate_phi * Eigen::AngleAxisd(q.theta, i).toRotationMatrix() * about_z(rig.yaw - rig.skew);
  const Vector3d n = rotate * k;                                   // (3)
  const Vector3d p = rotate * Vector3d(q.x, q.y, rig.height);      // (5)
  const Vector3d c = rotate * Vector3d(q.x, q.y, rig.height + r);  // (6)
  const Vector3d theta_axis = rotate_phi * i;

  const Vector6 s1 = q.phi_dot * stack(j, Vector3d::Zero());             // (7)
  const Vector6 s2 = q.theta_dot * stack(theta_axis, Vector3d::Zero());  // (8)
  const Vector3d plane_omega = (s1 + s2).head<3>();
  const Vector6 s1_dot = q.phi_ddot * stack(j, Vector3d::Zero());
  const Vector6 s2_dot =
      stack(q.theta_ddot * theta_axis + q.theta_dot * (q.phi_dot * j).cross(theta_axis),
            Vector3d::Zero());

  // (11) and its derivative: an axis fixed in the plane, through the contact point.
  const Vector3d p_dot = plane_omega.cross(p) + rotate * Vector3d(q.x_dot, q.y_dot, 0);
  const auto through_contact = [&](const Vector3d& axis) { return stack(axis, p.cross(axis)); };
  const auto through_contact_dot = [&](const Vector3d& axis) {
    const Vector3d axis_dot = plane_omega.cross(axis);
    return stack(axis_dot, p_dot.cross(axis) + p.cross(axis_dot));
  };
  const Vector3d axes[3] = {rotate * Vector3d::UnitY(), rotate * i, n};
  const double signs_over_r[3] = {1 / r, -1 / r, 1};  // (10)
  const double rates[3] = {q.x_dot, q.y_dot, q.gamma_dot};

  Vector6 s = s1 + s2, s_dot_known = s1_dot + s2_dot;
  Eigen::Matrix<double, 6, 3> screws, unknown;
  for (int a = 0; a < 3; ++a) {
    screws.col(a) = through_contact(axes[a]);
    unknown.col(a) = signs_over_r[a] * screws.col(a);
    s += rates[a] * unknown.col(a);
    s_dot_known += rates[a] * signs_over_r[a] * through_contact_dot(axes[a]);
  }

  Matrix6 home = Matrix6::Zero();  // (17)
  home.topLeftCorner<3, 3>() =
      m * r * r * Vector3d(1 + rig.k, 1 + rig.k, rig.k).asDiagonal().toDenseMatrix();
  home.topRightCorner<3, 3>() = m * r * ad(k);
  home.bottomLeftCorner<3, 3>() = m * r * ad(k).transpose();
  home.bottomRightCorner<3, 3>() = m * Matrix3d::Identity();
  Matrix6 adjoint_inverse = Matrix6::Zero();  // (20)
  adjoint_inverse.topLeftCorner<3, 3>() = rotate.transpose();
  adjoint_inverse.bottomLeftCorner<3, 3>() = -rotate.transpose() * ad(p);
  adjoint_inverse.bottomRightCorner<3, 3>() = rotate.transpose();
  const Matrix6 inertia = adjoint_inverse.transpose() * home * adjoint_inverse;  // (18)

  const Vector6 momentum = inertia * s;
  const Vector3d omega = s.head<3>(), v = s.tail<3>();
  const Vector3d angular = momentum.head<3>(), linear = momentum.tail<3>();
  const Vector6 bracket = stack(omega.cross(angular) + v.cross(linear), omega.cross(linear));

  const double lambda = m * g * std::cos(q.theta) * std::cos(q.phi);                     // (24)
  const Vector6 wrench = -m * g * stack(c.cross(k), k) + lambda * stack(c.cross(n), n);  // (25)

  const Matrix3d mass = screws.transpose() * inertia * unknown;
  const Vector3d load = screws.transpose() * (wrench - bracket - inertia * s_dot_known);
  return mass.partialPivLu().solve(load);
}

}  // namespace twist_form
