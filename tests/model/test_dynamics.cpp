// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Contact force, torques and energy, against statics and each other.
#include <algorithm>
#include <array>
#include <cmath>

#include "catch.hpp"
#include "model/ball/dynamics.hpp"
#include "model/model.hpp"
#include "model/random_states.hpp"
#include "support/scenes.hpp"

namespace bbsim_test::test_dynamics {

using namespace bbsim::model;
using bbsim_test::Random;

namespace {

constexpr double epsilon = 2.3e-16;

// Within a dozen rounding errors of the value.
bool near(double value, double expected) {
  return std::abs(value - expected) <= 12 * epsilon * std::abs(expected);
}

// One classical Runge-Kutta step of the open loop, error O(h^5).
template <class System>
std::array<double, System::size> step(const System& system, double t, const double* z, double h) {
  constexpr int n = System::size;
  std::array<double, n> k[4], at;
  const double part[4] = {0, h / 2, h / 2, h};
  for (int stage = 0; stage < 4; ++stage) {
    for (int i = 0; i < n; ++i) at[i] = z[i] + (stage > 0 ? part[stage] * k[stage - 1][i] : 0);
    system.derivative(t + part[stage], at.data(), k[stage].data());
  }
  for (int i = 0; i < n; ++i) at[i] = z[i] + h / 6 * (k[0][i] + 2 * (k[1][i] + k[2][i]) + k[3][i]);
  return at;
}

}  // namespace

TEST_CASE("a ball at rest on a level plane weighs m g and needs no friction") {
  Sample sample;
  sample.ball.x = 0.05;
  const Dynamics d = dynamics(sample, {0.01, 0.2, 9.81});
  CHECK(near(d.normal_force(), 0.2 * 9.81));
  CHECK(d.friction_force() == 0);
  // The weight m g at x = 5 cm: positive phi lowers x, so the motor must hold against it.
  CHECK(near(d.torque_phi, -0.05 * 0.2 * 9.81));
  CHECK(d.torque_theta == 0);
  CHECK(near(d.energy(), 0.2 * 9.81 * 0.01));
}

TEST_CASE("on a fixed incline friction carries 2/7 of the weight along it") {
  Sample sample;
  sample.gimbal.phi = 0.3;
  const Dynamics d = dynamics(sample, {0.01, 0.2, 9.81});
  CHECK(near(d.normal_force(), 0.2 * 9.81 * std::cos(0.3)));
  CHECK(near(d.friction_force(), 2.0 / 7 * 0.2 * 9.81 * std::sin(0.3)));
}

TEST_CASE("the energy changes by the power of the motor torques") {
  bbsim::Scenario scene = bbsim_test::fig2a();
  scene.gimbal.motion->phi = {bbsim::Sinusoid{0.4, 3, 0.5, 0.1}};
  scene.gimbal.motion->theta = {bbsim::Sinusoid{0.5, 2, 1, -0.1}};
  const auto system = std::get<OpenLoop<Shape::full>>(assemble(scene, false).system);
  const BallConstants constants{0.01, 0.2, 9.81};
  Random random(9);
  for (int repeat = 0; repeat < 50; ++repeat) {
    double z[5];
    for (double& value : z) value = random.uniform(-0.3, 0.3);
    const double t = random.uniform(0, 5);
    const auto energy_after = [&](double h) {
      return dynamics(system.sample(t + h, step(system, t, z, h).data()), constants).energy();
    };
    // Central differences at h and h / 2, extrapolated: error O(h^4), and rounding eps E / h.
    const double h = 1e-3;
    const double coarse = (energy_after(h) - energy_after(-h)) / (2 * h);
    const double fine = (energy_after(h / 2) - energy_after(-h / 2)) / h;
    const double rate = (4 * fine - coarse) / 3;
    const Sample now = system.sample(t, z);
    const Dynamics d = dynamics(now, constants);
    const double power = d.torque_phi * now.gimbal.phi_dot + d.torque_theta * now.gimbal.theta_dot;
    // h^4 times the fifth derivative of the energy, up to 10^3 J/s^5 here; rounding 1e-12.
    CHECK(std::abs(rate - power) < 1e-9);
  }
}

}  // namespace bbsim_test::test_dynamics
