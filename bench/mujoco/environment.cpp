// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Control periods per second of processor time with MuJoCo (Todorov, Erez and Tassa 2012), for a
// rig like configs/rig.yaml. bench/environments.py counts the same for bbsim.VectorEnv.
//
// The rig: a plate on two hinges with second-order position servos, a solid ball, and a law that
// brings the ball to the center, once every 20 ms. The law sees the true position and velocity, so
// sensors cost no time. Rigs run one after another, as MuJoCo has no vectorized steps on
// processors.
//
//     mujoco_environment
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <memory>
#include <string>

#include "compiled.hpp"

namespace {

constexpr double period = 0.02, frequency = 31.4, damping = 0.8, inertia = 4e-3;
constexpr double limit = 0.2;  // of a command, rad
constexpr int rigs = 1024, periods = 100;

std::string scene(double step) {
  const std::string kp = std::to_string(inertia * frequency * frequency);
  const std::string kv = std::to_string(2 * damping * frequency * inertia);
  std::string servos;
  for (const char* const joint : {"phi", "theta"}) {
    servos += std::string("<general joint='") + joint + "' biastype='affine' gainprm='" + kp +
              "' biasprm='0 -" + kp + " -" + kv + "'/>";
  }
  return "<mujoco><option timestep='" + std::to_string(step) +
         "' gravity='0 0 -9.81'/><default><geom condim='3' friction='1 0 0'/></default><worldbody>"
         "<body><inertial pos='0 0 0' mass='1' diaginertia='4e-3 4e-3 8e-3'/>"
         "<joint name='phi' type='hinge' axis='1 0 0'/>"
         "<joint name='theta' type='hinge' axis='0 1 0'/>"
         "<geom type='box' size='0.16 0.12 0.005' pos='0 0 -0.005'/></body>"
         "<body pos='0.05 0 0.02'><freejoint/><geom type='sphere' size='0.02' mass='0.033'/></body>"
         "</worldbody><actuator>" +
         servos + "</actuator></mujoco>";
}

// Mean distance of the balls from the center at the end, m.
double balance(const mjModel* model, mjData* data, int steps) {
  double distance = 0;
  for (int rig = 0; rig < rigs; ++rig) {
    mj_resetData(model, data);
    for (int sample = 0; sample < periods; ++sample) {
      // The joints of the plate come first, then the ball's position.
      const double ax = -10 * data->qpos[2] - 5 * data->qvel[2];
      const double ay = -10 * data->qpos[3] - 5 * data->qvel[3];
      data->ctrl[0] = std::clamp(-1.4 / 9.81 * ay, -limit, limit);
      data->ctrl[1] = std::clamp(1.4 / 9.81 * ax, -limit, limit);
      for (int i = 0; i < steps; ++i) mj_step(model, data);
    }
    distance += std::hypot(data->qpos[2], data->qpos[3]) / rigs;
  }
  return distance;
}

}  // namespace

int main() {
  std::printf("%-10s %-28s %s\n", "step (ms)", "control periods per second", "distance (mm)");
  for (const double step : {5e-3, 2e-3, 1e-3}) {
    const auto model = compiled(scene(step));
    const std::unique_ptr<mjData, decltype(&mj_deleteData)> data(mj_makeData(model.get()),
                                                                 mj_deleteData);
    const std::clock_t before = std::clock();
    const double distance =
        balance(model.get(), data.get(), static_cast<int>(std::lround(period / step)));
    const double seconds = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
    std::printf("%-10g %-28.0f %.3g\n", 1e3 * step, rigs * periods / seconds, 1e3 * distance);
  }
  return 0;
}
