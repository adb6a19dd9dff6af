// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Newton-Euler equations with couples, at random states:
// docs/explanation/losses-and-torques.md.
#include <cmath>

#include "catch.hpp"
#include "model/model.hpp"
#include "model/random_states.hpp"
#include "model/systems/list.hpp"
#include "support/largest.hpp"
#include "support/reading.hpp"

namespace bbsim_test::test_coupled {

using namespace bbsim;

namespace {

Mounting random_mounting(Random& random) {
  Mounting mounting;
  mounting.height = random.uniform(-0.05, 0.05);
  mounting.skew = random.uniform(-0.5, 0.5);
  mounting.yaw = random.uniform(-1, 1);
  mounting.base_tilt = random.uniform(-0.3, 0.3);
  return mounting;
}

Scenario torque_driven(Random& random) {
  Scenario scene = test::parse(
      "ball: {radius: 0.02, mass: 0.05}\n"
      "plate: {inertia: [4e-3, 6e-3, 1e-2], mass: 0.5, centre_of_mass: -0.05}\n"
      "gimbal: {torque: {phi: 0.1, theta: -0.2}, ring_inertia: 2e-3, motor: {rotor_inertia: 1e-3, "
      "viscous: 0.02}}\n"
      "time: {end: 1, step: 1}\n");
  scene.gimbal.mounting = random_mounting(random);
  scene.ball.inertia_factor = random.uniform(0.1, 0.66);
  scene.ball.mass = random.uniform(0.001, 5);
  return scene;
}

void fill(Random& random, double (&z)[model::CoupledLoop<>::size]) {
  for (double& value : z) value = 0;
  for (int i = 0; i < 2; ++i) {
    z[i] = random.uniform(-0.3, 0.3);
    z[2 + i] = random.uniform(-1, 1);
    z[5 + i] = random.uniform(-1.5, 1.5);
    z[7 + i] = random.uniform(-3, 3);
  }
  z[4] = random.uniform(-1, 1);
}

}  // namespace

TEST_CASE("without couples a ball rolls by the general form of equation (27)") {
  Random random(1);
  double largest = 0;
  for (int i = 0; i < 1000; ++i) {
    const double r = random.uniform(0.005, 0.05), g = random.uniform(1, 20);
    Scenario scene;
    scene.ball.radius = r;
    scene.gravity = g;
    scene.ball.inertia_factor = random.uniform(0, 0.66);
    scene.gimbal.mounting = random_mounting(random);
    const model::CoupledBall coupled = model::coupled_ball(scene);
    const model::GimbalAngle<double> phi{std::sin(0.1 * i), std::cos(0.1 * i),
                                         random.uniform(-3, 3), random.uniform(-20, 20)};
    const model::GimbalAngle<double> theta{std::sin(0.2 * i), std::cos(0.2 * i),
                                           random.uniform(-3, 3), random.uniform(-20, 20)};
    const model::RollingState<double, double, double> ball{
        random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), random.uniform(-1, 1),
        random.uniform(-1, 1), random.uniform(-1, 1)};
    const double p[2] = {ball.x_dot, ball.y_dot};
    const auto plane = coupled.plane(phi, theta);
    auto cause = coupled.cause(plane, ball, p);
    for (int k = 0; k < 3; ++k) {
      cause.omega_dot[k] += plane.axis[0][k] * phi.acceleration;
      cause.omega_dot[k] += plane.axis[1][k] * theta.acceleration;
    }
    const auto answer = coupled.answer({}, {{0, 0}, {0, 0}}, ball, cause);
    const auto rates = model::general_rolling(scene).rates<double>(phi, theta, ball, r, g);
    largest = largest_finite(largest, {std::abs(answer.x - rates.x), std::abs(answer.y - rates.y),
                                       std::abs(answer.u - rates.u)});
  }
  CHECK(largest < 1e-13);  // relative to some 20 m/s^2
}

TEST_CASE("the motors' inertia matrix is symmetric and positive definite") {
  Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const model::Model model = model::assemble(torque_driven(random), false);
    auto loop = std::get<model::CoupledLoop<>>(model.system);
    double z[model::CoupledLoop<>::size];
    fill(random, z);
    for (const bool rests : {false, true}) {
      loop.parts.contact.rests = rests;  // a ball held by friction is part of the plate
      const auto h = loop.inertia(z);
      CAPTURE(i, rests);
      CHECK(std::abs(h[0][1] - h[1][0]) < 1e-14 * (h[0][0] + h[1][1]));
      CHECK(h[0][0] > 0);
      CHECK(h[0][0] * h[1][1] - h[0][1] * h[1][0] > 0);
    }
  }
}

TEST_CASE("the Jacobian of a coupled scene agrees with differences") {
  Random random(3);
  const Scenario scene = torque_driven(random);
  const model::Model model = model::assemble(scene, false);
  const auto& loop = std::get<model::CoupledLoop<>>(model.system);
  constexpr int n = model::CoupledLoop<>::size;
  double z[n];
  fill(random, z);
  Eigen::Matrix<double, n, n> exact;
  model::jacobian(model.system, 0.3, z, exact.data());
  for (int j = 0; j < n; ++j) {
    const double step = 1e-5, kept = z[j];
    double up[n], down[n];
    z[j] = kept + step;
    model::derivative(loop, 0.3, z, up);
    z[j] = kept - step;
    model::derivative(loop, 0.3, z, down);
    z[j] = kept;
    for (int i = 0; i < n; ++i) {
      CAPTURE(i, j);
      // Third derivatives of some hundreds times the squared step.
      CHECK(std::abs(exact(i, j) - (up[i] - down[i]) / (2 * step)) < 1e-5);
    }
  }
}

TEST_CASE("scenes without losses, sliding and torques are unchanged") {
  const Scenario scene = test::parse(test::open_loop);
  CHECK_FALSE(std::holds_alternative<model::CoupledGiven<>>(model::assemble(scene, false).system));
  Scenario with = scene;
  with.ball.losses = {0, 0, 0};
  with.events.slip = SlipEvent{0.3, OnEvent::note};
  CHECK_FALSE(std::holds_alternative<model::CoupledGiven<>>(model::assemble(with, false).system));
  with.ball.losses.rolling = 1e-9;
  CHECK(std::holds_alternative<model::CoupledGiven<>>(model::assemble(with, false).system));
}

}  // namespace bbsim_test::test_coupled
