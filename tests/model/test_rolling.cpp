// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Equation (27) and its general form, (M18) to (M20), against the paper's twist form; symmetries;
// and the force, the torques and the energy that follow.
#include <array>
#include <cmath>

#include "catch.hpp"
#include "model/ball/dynamics.hpp"
#include "model/ball/general_rolling.hpp"
#include "model/random_states.hpp"
#include "model/twist_form.hpp"
#include "support/scenes.hpp"

namespace bbsim_test::test_rolling {

using namespace bbsim;
using namespace bbsim::model;
using twist_form::State;

namespace {

constexpr double epsilon = 2.3e-16, g = 9.81;

State random_state(Random& random) {
  return {random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), random.uniform(-1, 1),
          random.uniform(-1, 1),     random.uniform(-60, 60),   random.uniform(-3, 3),
          random.uniform(-3, 3),     random.uniform(-5, 5),     random.uniform(-5, 5),
          random.uniform(-20, 20),   random.uniform(-20, 20)};
}

struct Motion {
  GimbalAngle<double> phi, theta;
  RollingState<double, double, double> ball;

  Motion(const State& q, double r)
      : phi{std::sin(q.phi), std::cos(q.phi), q.phi_dot, q.phi_ddot},
        theta{std::sin(q.theta), std::cos(q.theta), q.theta_dot, q.theta_ddot},
        ball{q.x, q.y, q.x_dot, q.y_dot, r * q.gamma_dot} {}
};

// x'', y'' and gamma'' of (27).
std::array<double, 3> compact(const State& q, double r) {
  const Motion m(q, r);
  return {Equation27::x<double>(m.phi, m.theta, m.ball, r, g),
          Equation27::y<double>(m.phi, m.theta, m.ball, r, g),
          Equation27::u<double>(m.phi, m.theta, m.ball, r) / r};
}

std::array<double, 3> general(const GeneralRolling& rolling, const State& q, double r) {
  const Motion m(q, r);
  const auto rates = rolling.rates<double>(m.phi, m.theta, m.ball, r, g);
  return {rates.x, rates.y, rates.u / r};
}

}  // namespace

TEST_CASE("equation (27) and its general form agree with the twist form, (7)-(26)") {
  Random random(27);
  for (int i = 0; i < 1000; ++i) {
    const State q = random_state(random);
    const double r = random.uniform(0.005, 0.05), mass = random.uniform(0.01, 2);
    const auto plain = compact(q, r), same = general({}, q, r);
    const Eigen::Vector3d paper = twist_form::accelerations(q, r, mass, g);
    Scenario scene = fig2a();
    scene.ball.inertia_factor = random.uniform(0.1, 0.9);
    Mounting& mounting = scene.gimbal.mounting;
    mounting.height = random.uniform(-0.1, 0.1);
    mounting.skew = random.uniform(-0.5, 0.5);
    mounting.yaw = random.uniform(-3, 3);
    mounting.base_tilt = random.uniform(-0.5, 0.5);
    const auto other = general(general_rolling(scene), q, r);
    const Eigen::Vector3d rig =
        twist_form::accelerations(q, r, mass, g,
                                  {scene.ball.inertia_factor, mounting.height, mounting.skew,
                                   mounting.yaw, mounting.base_tilt});
    // The twist form subtracts momenta about the origin, which exceed their difference by up to
    // (distance / r)^2: 0.45 m over 5 mm, squared, times the terms (about 100 m/s^2) and a hundred
    // rounding errors. The inertia of a rig's ball is down to a tenth.
    const double bound = 100 * epsilon * 100 * std::pow(0.45 / r, 2);
    for (int k = 0; k < 3; ++k) {
      const double length = k == 2 ? r : 1;  // gamma'' is per radius
      const auto at = static_cast<std::size_t>(k);
      CHECK(std::abs(plain[at] - paper[k]) * length < bound);
      CHECK(std::abs(other[at] - rig[k]) * length < bound / 0.1);
      // A few dozen rounding errors of terms up to 60 m/s^2.
      CHECK(std::abs(same[at] - plain[at]) * length < 30 * epsilon * 60);
    }
  }
}

TEST_CASE("mirror symmetries of equation (27) hold bit for bit") {
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    const State q = random_state(random);
    const auto original = compact(q, 0.01);
    State in_x = q, in_y = q;  // (x, phi, gamma) -> -(x, phi, gamma), and of y and theta
    for (double* value :
         {&in_x.x, &in_x.x_dot, &in_x.gamma_dot, &in_x.phi, &in_x.phi_dot, &in_x.phi_ddot, &in_y.y,
          &in_y.y_dot, &in_y.gamma_dot, &in_y.theta, &in_y.theta_dot, &in_y.theta_ddot}) {
      *value = -*value;
    }
    CHECK(compact(in_x, 0.01) == std::array{-original[0], original[1], -original[2]});
    CHECK(compact(in_y, 0.01) == std::array{original[0], -original[1], -original[2]});
  }
}

TEST_CASE("scaling lengths by L and times by sqrt(L) leaves equation (27) unchanged") {
  Random random(4);
  for (int i = 0; i < 200; ++i) {
    const State q = random_state(random);
    const double scale = 4, root = 2;  // exact in binary, so all bits agree
    State scaled = q;
    for (double* length : {&scaled.x, &scaled.y}) *length *= scale;
    for (double* speed : {&scaled.x_dot, &scaled.y_dot}) *speed *= root;
    for (double* rate : {&scaled.gamma_dot, &scaled.phi_dot, &scaled.theta_dot}) *rate /= root;
    for (double* change : {&scaled.phi_ddot, &scaled.theta_ddot}) *change /= scale;
    const auto original = compact(q, 0.01);  // accelerations: L / T^2 = 1
    CHECK(compact(scaled, 0.01 * scale) ==
          std::array{original[0], original[1], original[2] / scale});
  }
}

TEST_CASE("omitting terms known to be zero does not change the rest") {
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    const Motion m(random_state(random), 0.01);
    const GimbalAngle<double> level{0, 1, 0, 0};
    const double r = 0.01;
    const auto& b = m.ball;

    const RollingState<double, double, double> on_x{b.x, 0, b.x_dot, 0, 0};
    const RollingState<double, Zero, Zero> only_x{b.x, {}, b.x_dot, {}, {}};
    CHECK(Equation27::x<double>(m.phi, LockedAngle{}, only_x, r, g) ==
          Equation27::x<double>(m.phi, level, on_x, r, g));
    CHECK(Equation27::y<double>(m.phi, level, on_x, r, g) == 0);
    CHECK(Equation27::u<double>(m.phi, level, on_x, r) == 0);

    const RollingState<double, double, double> on_y{0, b.y, 0, b.y_dot, 0};
    const RollingState<Zero, double, Zero> only_y{{}, b.y, {}, b.y_dot, {}};
    CHECK(Equation27::y<double>(LockedAngle{}, m.theta, only_y, r, g) ==
          Equation27::y<double>(level, m.theta, on_y, r, g));
    CHECK(Equation27::x<double>(level, m.theta, on_y, r, g) == 0);
    CHECK(Equation27::u<double>(level, m.theta, on_y, r) == 0);
  }
}

TEST_CASE("a fixed incline: s'' = g sin / (1 + k), at any height") {
  for (const double k : {0.0, 0.4, 2.0 / 3, 1.0}) {
    GeneralRolling rolling;
    rolling.k = k;
    rolling.height = 0.07;
    const State on_phi{0.1, -0.2, 0.3, 0.1, 5, 0.3, 0, 0, 0, 0, 0},
        on_theta{0.1, -0.2, 0.3, 0.1, 5, 0, 0.3, 0, 0, 0, 0};
    CHECK(general(rolling, on_phi, 0.01)[0] == Approx(g * std::sin(0.3) / (1 + k)).epsilon(1e-14));
    CHECK(general(rolling, on_theta, 0.01)[1] ==
          Approx(-g * std::sin(0.3) / (1 + k)).epsilon(1e-14));
  }
}

TEST_CASE("force and torques of a ball at rest, level and on an incline") {
  const double weight = 0.2 * 9.81, rounding = 12 * epsilon;
  Sample sample;
  sample.ball.x = 0.05;
  const Dynamics level = dynamics(sample, {0.01, 0.2, 9.81});
  CHECK(level.normal_force() == Approx(weight).epsilon(rounding));
  CHECK(level.friction_force() == 0);
  // Positive phi lowers x, so the motor must hold against the ball's weight at x = 5 cm.
  CHECK(level.torque_phi == Approx(-0.05 * weight).epsilon(rounding));
  CHECK(level.torque_theta == 0);
  CHECK(level.energy() == Approx(weight * 0.01).epsilon(rounding));
  sample.gimbal.phi = 0.3;  // friction carries 2/7 of the weight along it
  const Dynamics tilted = dynamics(sample, {0.01, 0.2, 9.81});
  CHECK(tilted.normal_force() == Approx(weight * std::cos(0.3)).epsilon(rounding));
  CHECK(tilted.friction_force() == Approx(2.0 / 7 * weight * std::sin(0.3)).epsilon(rounding));
}

TEST_CASE("on any rig the motors' power equals the rate of change of the energy") {
  const bool of_the_paper = GENERATE(true, false);
  Random random(20);
  Scenario scene = fig2a();
  if (!of_the_paper) {
    scene.ball.inertia_factor = 2.0 / 3;
    scene.gimbal.mounting = {0.05, 0, 0, 0.2, 0.7, 0.1};
  }
  const BallConstants constants = constants_of(scene);
  for (int i = 0; i < 100; ++i) {
    State q = random_state(random);
    q.gamma_dot /= 10;
    const auto a = general(constants.rolling, q, scene.ball.radius);
    // The state a time h later, to second order; central differences give the energy's rate.
    const auto sample_at = [&](double h) {
      const double s = h * h / 2;
      Sample later;
      later.ball = {q.x + h * q.x_dot + s * a[0], q.y + h * q.y_dot + s * a[1], q.x_dot + h * a[0],
                    q.y_dot + h * a[1], q.gamma_dot + h * a[2]};
      later.gimbal = {q.phi + h * q.phi_dot + s * q.phi_ddot,
                      q.theta + h * q.theta_dot + s * q.theta_ddot,
                      q.phi_dot + h * q.phi_ddot,
                      q.theta_dot + h * q.theta_ddot,
                      q.phi_ddot,
                      q.theta_ddot};
      return later;
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

}  // namespace bbsim_test::test_rolling
