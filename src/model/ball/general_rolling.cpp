// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/ball/general_rolling.hpp"

#include <cmath>

namespace bbsim::model {

bool is_the_papers(const Scenario& scene) {
  return scene.gimbal.mounting == Mounting{} && scene.ball.inertia_factor == 0.4;
}

GeneralRolling general_rolling(const Scenario& scene) {
  const Mounting& mounting = scene.gimbal.mounting;
  const double turn = mounting.yaw - mounting.skew;
  GeneralRolling rolling;
  rolling.k = scene.ball.inertia_factor;
  rolling.height = mounting.height;
  rolling.cos_skew = std::cos(mounting.skew);
  rolling.sin_skew = std::sin(mounting.skew);
  rolling.cos_turn = std::cos(turn);
  rolling.sin_turn = std::sin(turn);
  rolling.cos_base = std::cos(mounting.base_tilt);
  rolling.sin_base = std::sin(mounting.base_tilt);
  return rolling;
}

}  // namespace bbsim::model
