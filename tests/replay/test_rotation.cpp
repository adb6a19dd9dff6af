// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The ball's and the plane's orientation against their definitions.
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "catch.hpp"
#include "replay/scene.hpp"

namespace bbsim_test::test_rotation {

using bbsim::Quaternion;
using namespace bbsim::replay;

namespace {

constexpr double pi = std::numbers::pi;

Eigen::Quaterniond eigen(const Quaternion& q) {
  return {q[0], q[1], q[2], q[3]};
}

// Angle of the rotation from one to the other, in rad, from products of doubles of size 1.
double apart(const Quaternion& a, const Eigen::Quaterniond& b) {
  return eigen(a).angularDistance(b);
}

}  // namespace

TEST_CASE("a ball that rolls along x turns about y, once per circumference") {
  const double r = 0.02;
  const std::vector<double> x{0, pi * r / 2, pi * r, 2 * pi * r}, y{0, 0, 0, 0};
  const auto turned = rolled(x, y, nullptr, r);
  CHECK(apart(turned[0], Eigen::Quaterniond::Identity()) < 1e-7);
  // After a quarter turn its top points along x.
  const Eigen::Vector3d top = eigen(turned[1]) * Eigen::Vector3d::UnitZ();
  CHECK((top - Eigen::Vector3d::UnitX()).norm() < 1e-12);
  CHECK(apart(turned[3], Eigen::Quaterniond::Identity()) < 1e-7);
}

TEST_CASE("gamma turns the ball about the normal") {
  const std::vector<double> none{0, 0, 0}, gamma{0, 0.3, 1.1};
  const auto turned = rolled(none, none, &gamma, 0.01);
  CHECK(apart(turned[2], Eigen::Quaterniond(Eigen::AngleAxisd(1.1, Eigen::Vector3d::UnitZ()))) <
        1e-7);
}

TEST_CASE("around a circle the error of rolling from row to row is second order") {
  // Rolling around a circle of radius R with w = angle: in the frame that rotates with the contact
  // point the ball turns at a constant rate, so its orientation has a closed form.
  const double r = 0.01, big = 0.05, angle = 2;
  const auto error = [&](int rows) {
    std::vector<double> x, y;
    for (int i = 0; i <= rows; ++i) {
      const double a = angle * i / rows;
      x.push_back(big * std::cos(a));
      y.push_back(big * std::sin(a));
    }
    // omega = R_z(a) (-big a'/r, 0, 0)  =>  Q = R_z(a) exp((-big/r, 0, -1) a).
    const double along = -big / r * angle, normal = -angle;
    const Eigen::Vector3d axis(along, 0, normal);
    const Eigen::Quaterniond exact =
        Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()) *
        Eigen::Quaterniond(Eigen::AngleAxisd(axis.norm(), axis.normalized()));
    return apart(rolled(x, y, nullptr, r).back(), exact);
  };
  const double coarse = error(100), fine = error(200);
  CHECK(coarse < 0.01);
  CHECK(std::log2(coarse / fine) > 1.9);
}

TEST_CASE("a slipping ball turns by its distance minus the slip") {
  // It moves at 1 m/s and slips at 3 - 2 t m/s: in a second it turns by -1 m over its radius.
  Run run;
  run.rolls = false;
  run.scenario.emplace().ball.radius = 1;
  run.columns = {{"t", {}}, {"x", {}}, {"y", {}}, {"slip_x", {}}, {"slip_y", {}}};
  for (int i = 0; i <= 10; ++i) {
    const double t = 0.1 * i;
    const double values[] = {t, t, 0, 3 - 2 * t, 0};
    for (std::size_t c = 0; c < run.columns.size(); ++c)
      run.columns[c].numbers.push_back(values[c]);
  }
  CHECK(orientation_of(run, 1).empty());  // its pivoting is unknown
  run.columns.push_back({"spin", std::vector<double>(11, 0.0)});
  const Quaternion last = orientation_of(run, 1).back();
  CHECK(apart(last, Eigen::Quaterniond(Eigen::AngleAxisd(-1, Eigen::Vector3d::UnitY()))) < 1e-7);
  // A recorded spin is integrated.
  run.columns.back().numbers.assign(11, 0.5);
  run.columns[3].numbers.assign(11, 1.0);
  CHECK(apart(orientation_of(run, 1).back(),
              Eigen::Quaterniond(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()))) < 1e-7);
}

TEST_CASE("a row of NaN keeps the last orientation, and the next row continues") {
  const std::vector<double> x{0, std::nan(""), 0.01, 0.02}, y{0, 0, 0, 0};
  const auto turned = rolled(x, y, nullptr, 0.01);
  CHECK(turned[1] == turned[0]);
  for (const auto& q : turned) CHECK(eigen(q).norm() == Approx(1));
}

}  // namespace bbsim_test::test_rotation
