// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Scenes shared by tests, built without YAML.
#pragma once

#include <numbers>

#include "scenario/scenario.hpp"

namespace bbsim_test {

// Fig. 2(a) of the paper, equation (30).
inline bbsim::Scenario fig2a() {
  bbsim::Scenario scene;
  scene.gravity = 9.81;
  scene.ball.radius = 0.01;
  scene.ball.position = {0, -0.10};
  scene.gimbal.motion = {{bbsim::Sinusoid{0.01, 1, std::numbers::pi / 2, 0}},
                         {bbsim::Sinusoid{-0.01, 1, 0, 0}}};
  scene.time = {10, 0.1};
  return scene;
}

// Fig. 2(b), with the gains acting through a position servo.
inline bbsim::Scenario fig2b() {
  bbsim::Scenario scene;
  scene.gravity = 9.81;
  scene.ball.radius = 0.01;
  scene.ball.position = {0.05, 0};
  scene.gimbal.servo = bbsim::Servo{10, 1};
  bbsim::Controller controller;
  controller.kv = {{{1, 0}, {0, -1}}};
  controller.kp = {{{0.001, 0}, {0, -0.001}}};
  controller.drives = bbsim::Drives::angle;
  controller.reference = bbsim::CircleReference{0.05, -0.3, 0};
  scene.controller = controller;
  scene.time = {21, 0.1};
  return scene;
}

// Fig. 2(b) with equation (31) and the gains exactly as printed.
inline bbsim::Scenario fig2b_literal() {
  bbsim::Scenario scene = fig2b();
  scene.gimbal.servo.reset();
  scene.controller->kv = {{{100, 0}, {0, 100}}};
  scene.controller->kp = {{{0.1, 0}, {0, 0.1}}};
  scene.controller->drives = bbsim::Drives::acceleration;
  scene.time = {21, 0.01};
  return scene;
}

}  // namespace bbsim_test
