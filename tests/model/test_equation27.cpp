// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Equation (27) in compact form against the paper's twist form, and its symmetries.
#include <array>
#include <cmath>

#include "catch.hpp"
#include "model/ball/rolling.hpp"
#include "model/random_states.hpp"
#include "model/twist_form.hpp"

namespace bbsim_test::test_equation27 {

using namespace bbsim::model;
using bbsim_test::Random;

namespace {

constexpr double epsilon = 2.3e-16;

twist_form::State random_state(Random& random) {
  return {random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), random.uniform(-1, 1),
          random.uniform(-1, 1),     random.uniform(-60, 60),   random.uniform(-3, 3),
          random.uniform(-3, 3),     random.uniform(-5, 5),     random.uniform(-5, 5),
          random.uniform(-20, 20),   random.uniform(-20, 20)};
}

std::array<double, 3> compact(const twist_form::State& q, double r, double g) {
  const GimbalAngle<double> phi{std::sin(q.phi), std::cos(q.phi), q.phi_dot, q.phi_ddot};
  const GimbalAngle<double> theta{std::sin(q.theta), std::cos(q.theta), q.theta_dot, q.theta_ddot};
  const RollingState<double, double, double> ball{q.x, q.y, q.x_dot, q.y_dot, r * q.gamma_dot};
  return {x_acceleration<double>(phi, theta, ball, r, g),
          y_acceleration<double>(phi, theta, ball, r, g),
          u_acceleration<double>(phi, theta, ball, r) / r};
}

}  // namespace

TEST_CASE("equation (27) agrees with the twist form, (7)-(26)") {
  Random random(27);
  for (int i = 0; i < 1000; ++i) {
    const twist_form::State q = random_state(random);
    const double r = random.uniform(0.005, 0.05), g = 9.81;
    const Eigen::Vector3d expected = twist_form::accelerations(q, r, random.uniform(0.01, 2), g);
    const auto [x_ddot, y_ddot, gamma_ddot] = compact(q, r, g);
    // The twist form subtracts momenta about the origin, which exceed their difference by up to
    // (distance / r)^2: 0.42 m over 5 mm, squared, times the terms (about 100 m/s^2) and a hundred
    // rounding errors.
    const double bound = 100 * epsilon * 100 * std::pow(0.45 / r, 2);
    CHECK(std::abs(x_ddot - expected[0]) < bound);
    CHECK(std::abs(y_ddot - expected[1]) < bound);
    CHECK(std::abs(gamma_ddot - expected[2]) < bound / r);
  }
}

TEST_CASE("mirror symmetries of equation (27) hold bit for bit") {
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    const twist_form::State q = random_state(random);
    const auto original = compact(q, 0.01, 9.81);

    twist_form::State mirrored = q;  // (x, phi, gamma) -> -(x, phi, gamma)
    for (double* value : {&mirrored.x, &mirrored.x_dot, &mirrored.gamma_dot, &mirrored.phi,
                          &mirrored.phi_dot, &mirrored.phi_ddot}) {
      *value = -*value;
    }
    auto image = compact(mirrored, 0.01, 9.81);
    CHECK(image[0] == -original[0]);
    CHECK(image[1] == original[1]);
    CHECK(image[2] == -original[2]);

    mirrored = q;  // (y, theta, gamma) -> -(y, theta, gamma)
    for (double* value : {&mirrored.y, &mirrored.y_dot, &mirrored.gamma_dot, &mirrored.theta,
                          &mirrored.theta_dot, &mirrored.theta_ddot}) {
      *value = -*value;
    }
    image = compact(mirrored, 0.01, 9.81);
    CHECK(image[0] == original[0]);
    CHECK(image[1] == -original[1]);
    CHECK(image[2] == -original[2]);
  }
}

TEST_CASE("scaling lengths by L and times by sqrt(L) leaves equation (27) unchanged") {
  Random random(4);
  for (int i = 0; i < 200; ++i) {
    const twist_form::State q = random_state(random);
    const double scale = 4, root = 2;  // exact in binary, so all bits agree
    const twist_form::State scaled{scale * q.x,
                                   scale * q.y,
                                   root * q.x_dot,
                                   root * q.y_dot,
                                   q.gamma_dot / root,
                                   q.phi,
                                   q.theta,
                                   q.phi_dot / root,
                                   q.theta_dot / root,
                                   q.phi_ddot / scale,
                                   q.theta_ddot / scale};
    const auto original = compact(q, 0.01, 9.81);
    const auto image = compact(scaled, 0.01 * scale, 9.81);
    CHECK(image[0] == original[0]);  // acceleration: L / T^2 = 1
    CHECK(image[1] == original[1]);
    CHECK(image[2] == original[2] / scale);
  }
}

TEST_CASE("omitting terms known to be zero does not change the rest") {
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    const twist_form::State q = random_state(random);
    const GimbalAngle<double> phi{std::sin(q.phi), std::cos(q.phi), q.phi_dot, q.phi_ddot};
    const GimbalAngle<double> theta{std::sin(q.theta), std::cos(q.theta), q.theta_dot,
                                    q.theta_ddot};
    const GimbalAngle<double> level{0, 1, 0, 0};
    const double r = 0.01, g = 9.81;

    const RollingState<double, double, double> on_x{q.x, 0, q.x_dot, 0, 0};
    const RollingState<double, Zero, Zero> only_x{q.x, {}, q.x_dot, {}, {}};
    CHECK(x_acceleration<double>(phi, LockedAngle{}, only_x, r, g) ==
          x_acceleration<double>(phi, level, on_x, r, g));
    CHECK(y_acceleration<double>(phi, level, on_x, r, g) == 0);
    CHECK(u_acceleration<double>(phi, level, on_x, r) == 0);

    const RollingState<double, double, double> on_y{0, q.y, 0, q.y_dot, 0};
    const RollingState<Zero, double, Zero> only_y{{}, q.y, {}, q.y_dot, {}};
    CHECK(y_acceleration<double>(LockedAngle{}, theta, only_y, r, g) ==
          y_acceleration<double>(level, theta, on_y, r, g));
    CHECK(x_acceleration<double>(level, theta, on_y, r, g) == 0);
    CHECK(u_acceleration<double>(level, theta, on_y, r) == 0);
  }
}

}  // namespace bbsim_test::test_equation27
