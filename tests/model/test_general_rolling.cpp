// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Equation (27) for any inertia factor and mounting, (M18) to (M20), against the twist form.
#include <cmath>

#include "catch.hpp"
#include "model/ball/dynamics.hpp"
#include "model/ball/general_rolling.hpp"
#include "model/random_states.hpp"
#include "model/twist_form.hpp"
#include "support/scenes.hpp"

namespace bbsim_test::test_general_rolling {

using namespace bbsim;
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

struct Motion {
  GimbalAngle<double> phi, theta;
  RollingState<double, double, double> ball;
};

Motion motion_of(const twist_form::State& q, double r) {
  return {{std::sin(q.phi), std::cos(q.phi), q.phi_dot, q.phi_ddot},
          {std::sin(q.theta), std::cos(q.theta), q.theta_dot, q.theta_ddot},
          {q.x, q.y, q.x_dot, q.y_dot, r * q.gamma_dot}};
}

}  // namespace

TEST_CASE("with the paper's rig the general equation equals (27)") {
  Random random(18);
  for (int i = 0; i < 1000; ++i) {
    const double r = random.uniform(0.005, 0.05), g = 9.81;
    const Motion m = motion_of(random_state(random), r);
    const auto rates = GeneralRolling{}.rates<double>(m.phi, m.theta, m.ball, r, g);
    // A few dozen rounding errors of terms up to 60 m/s^2.
    const double bound = 30 * epsilon * 60;
    CHECK(std::abs(rates.x - x_acceleration<double>(m.phi, m.theta, m.ball, r, g)) < bound);
    CHECK(std::abs(rates.y - y_acceleration<double>(m.phi, m.theta, m.ball, r, g)) < bound);
    CHECK(std::abs(rates.u - u_acceleration<double>(m.phi, m.theta, m.ball, r)) < bound);
  }
}

TEST_CASE("the general equation agrees with the twist form on rigs of all kinds") {
  Random random(19);
  for (int i = 0; i < 1000; ++i) {
    const twist_form::State q = random_state(random);
    const double r = random.uniform(0.005, 0.05), g = 9.81;
    Scenario scene = bbsim_test::fig2a();
    scene.ball.inertia_factor = random.uniform(0.1, 0.9);
    Mounting& mounting = scene.gimbal.mounting;
    mounting.height = random.uniform(-0.1, 0.1);
    mounting.skew = random.uniform(-0.5, 0.5);
    mounting.yaw = random.uniform(-3, 3);
    mounting.base_tilt = random.uniform(-0.5, 0.5);
    const Motion m = motion_of(q, r);
    const auto rates = general_rolling(scene).rates<double>(m.phi, m.theta, m.ball, r, g);
    const Eigen::Vector3d expected =
        twist_form::accelerations(q, r, random.uniform(0.01, 2), g,
                                  {scene.ball.inertia_factor, mounting.height, mounting.skew,
                                   mounting.yaw, mounting.base_tilt});
    // As for (27): momenta about the origin, 0.45 m away, with terms of 100 m/s^2, divided by an
    // inertia down to a tenth.
    const double bound = 100 * epsilon * 100 * std::pow(0.45 / r, 2) / 0.1;
    CHECK(std::abs(rates.x - expected[0]) < bound);
    CHECK(std::abs(rates.y - expected[1]) < bound);
    CHECK(std::abs(rates.u / r - expected[2]) < bound / r);
  }
}

TEST_CASE("a fixed incline: s'' = g sin / (1 + k), at any height") {
  for (const double k : {0.0, 0.4, 2.0 / 3, 1.0}) {
    GeneralRolling rolling;
    rolling.k = k;
    rolling.height = 0.07;
    const double phi = 0.3, g = 9.81;
    const GimbalAngle<double> tilted{std::sin(phi), std::cos(phi), 0, 0}, level{0, 1, 0, 0};
    const RollingState<double, double, double> ball{0.1, -0.2, 0.3, 0.1, 0.05};
    CHECK(rolling.rates<double>(tilted, level, ball, 0.01, g).x ==
          Approx(g * std::sin(phi) / (1 + k)).epsilon(1e-14));
    CHECK(rolling.rates<double>(level, tilted, ball, 0.01, g).y ==
          Approx(-g * std::sin(phi) / (1 + k)).epsilon(1e-14));
  }
}

TEST_CASE("on any rig the motors' power equals the rate of change of the energy") {
  Random random(20);
  Scenario scene = bbsim_test::fig2a();
  scene.ball.inertia_factor = 2.0 / 3;
  scene.gimbal.mounting = {0.05, 0, 0, 0.2, 0.7, 0.1};
  const BallConstants constants = constants_of(scene);
  const double r = scene.ball.radius, g = scene.gravity;
  for (int i = 0; i < 100; ++i) {
    twist_form::State q = random_state(random);
    q.gamma_dot /= 10;
    // The state a time h later, to second order; central differences give the energy's rate.
    const auto sample_at = [&](double h) {
      const Motion m = motion_of(q, r);
      const auto rates = constants.rolling.rates<double>(m.phi, m.theta, m.ball, r, g);
      Sample s;
      s.ball = {q.x + h * q.x_dot + h * h / 2 * rates.x, q.y + h * q.y_dot + h * h / 2 * rates.y,
                q.x_dot + h * rates.x, q.y_dot + h * rates.y, q.gamma_dot + h * rates.u / r};
      s.gimbal = {q.phi + h * q.phi_dot + h * h / 2 * q.phi_ddot,
                  q.theta + h * q.theta_dot + h * h / 2 * q.theta_ddot,
                  q.phi_dot + h * q.phi_ddot,
                  q.theta_dot + h * q.theta_ddot,
                  q.phi_ddot,
                  q.theta_ddot};
      return s;
    };
    const double h = 1e-5;
    const double rate =
        (dynamics(sample_at(h), constants).energy() - dynamics(sample_at(-h), constants).energy()) /
        (2 * h);
    const Dynamics now = dynamics(sample_at(0), constants);
    const double power = now.torque_phi * q.phi_dot + now.torque_theta * q.theta_dot;
    // Differences: h^2 times the third derivative, of energies of some joules that change within
    // 1/20 s, and their rounding divided by h.
    CHECK(std::abs(rate - power) < h * h * 20 * 8000 + 1e-15 * 20 / h);
  }
}

}  // namespace bbsim_test::test_general_rolling
