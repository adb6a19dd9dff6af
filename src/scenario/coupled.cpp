// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "scenario/coupled.hpp"

namespace bbsim::scenario {

bool moved_by_torques(const Scenario& scene) {
  if (scene.gimbal.torque) return true;
  if (!scene.controller) return false;
  const Drives drives = scene.controller->drives;
  return drives == Drives::torque || drives == Drives::voltage ||
         (drives == Drives::angle && scene.gimbal.motor && scene.gimbal.motor->position_loop);
}

bool has_dry_losses(const Scenario& scene) {
  return scene.ball.losses.rolling > 0 || scene.ball.losses.pivoting > 0;
}

const char* dry_part(const Scenario& scene) {
  if (scene.ball.losses.rolling > 0) return "ball.losses.rolling";
  if (scene.ball.losses.pivoting > 0) return "ball.losses.pivoting";
  if (scene.events.slip && scene.events.slip->sliding) return "events.slip with action: slide";
  if (moved_by_torques(scene) && scene.gimbal.motor && scene.gimbal.motor->friction > 0) {
    return "gimbal.motor.friction";
  }
  return nullptr;
}

bool is_coupled(const Scenario& scene) {
  return scene.ball.push || scene.ball.losses.any() ||
         (scene.events.slip && scene.events.slip->sliding) || moved_by_torques(scene);
}

bool is_linked(const Scenario& scene) {
  const Gimbal& gimbal = scene.gimbal;
  return gimbal.linkage[0] || gimbal.linkage[1] || gimbal.three_servos;
}

}  // namespace bbsim::scenario
