// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Compares rolling resistance with MuJoCo, an engine with soft contacts (Todorov, Erez and Tassa
// 2012).
//
// One ball rolls along a level plate to rest. Another rests on a plate tilted by half of the angle
// that the resistance holds. Both have a couple c_rr N r against rolling. MuJoCo makes friction a
// soft constraint, which equals dry friction while the ball rolls, but lets it creep at rest. The
// creep shrinks with the constraint's time constant (solref), and the time constant with the step.
//
//     crosscheck_losses
#include <mujoco/mujoco.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <sstream>
#include <string>

#include "compiled.hpp"
#include "model/model.hpp"
#include "scenario/reader.hpp"
#include "solve/integrate.hpp"

namespace {

constexpr double radius = 0.02, mass = 0.05, gravity = 9.81, rolling = 0.002;
constexpr double speed = 0.12, level_end = 10, tilted_end = 100;

std::string text(double number) {
  char digits[40];
  std::snprintf(digits, sizeof digits, "%.17g", number);
  return digits;
}

// Position of the ball at the end, m.
double by_bbsim(double tilt, double velocity, double end) {
  const bbsim::Scenario scene = bbsim::parse_scenario(
      "gravity: " + text(gravity) + "\nball: {radius: " + text(radius) + ", mass: " + text(mass) +
          ", velocity: [" + text(velocity) + ", 0], losses: {rolling: " + text(rolling) +
          "}}\ngimbal: {motion: {phi: " + text(tilt) + "}}\ntime: {end: " + text(end) +
          ", step: " + text(end) + "}\n",
      "losses.yaml");
  const bbsim::model::Model model = bbsim::model::assemble(scene, false);
  const bbsim::solve::OutputGrid grid(scene.time);
  bbsim::solve::Trajectory rows(model.row_size());
  static_cast<void>(
      bbsim::solve::integrate(model, bbsim::Method::automatic, {1e-10, 1e-12}, grid, rows));
  return model.sample(end, rows.row(rows.rows() - 1)).ball.x;
}

double by_mujoco(double tilt, double velocity, double end, double step) {
  // MuJoCo's coefficients of rolling and torsion are lengths. The stiffest permitted time constant
  // is twice the step.
  std::ostringstream xml;
  xml << "<mujoco><option timestep='" << text(step) << "' cone='elliptic' "
      << "impratio='100' tolerance='1e-14' iterations='200' gravity='"
      << text(gravity * std::sin(tilt)) << " 0 " << text(-gravity * std::cos(tilt))
      << "'/><default><geom condim='6' solref='" << text(2 * step)
      << " 1' solimp='0.9999 0.9999 0.001' friction='1 0 " << text(rolling * radius)
      << "'/></default><worldbody><geom type='plane' size='100 100 1'/>"
      << "<body pos='0 0 " << text(radius) << "'><freejoint/><geom type='sphere' size='"
      << text(radius) << "' mass='" << text(mass) << "'/></body></worldbody></mujoco>";
  const auto model = compiled(xml.str());
  const std::unique_ptr<mjData, decltype(&mj_deleteData)> data(mj_makeData(model.get()),
                                                               mj_deleteData);
  data->qvel[0] = velocity;
  data->qvel[4] = velocity / radius;
  const long steps = std::lround(end / step);
  for (long i = 0; i < steps; ++i) mj_step(model.get(), data.get());
  return data->qpos[0];
}

}  // namespace

int main() {
  // v^2 (1 + kappa) / (2 c_rr g)
  const double distance = speed * speed * 1.4 / (2 * rolling * gravity);
  const double tilt = std::atan(rolling / 2);
  std::printf("%-16s %-24s %s\n", "", "rolls until at rest (m)", "creeps in 100 s at rest (m)");
  std::printf("%-16s %-24.15g %.15g\n", "closed form", distance, 0.0);
  std::printf("%-16s %-24.15g %.15g\n", "bbsim", by_bbsim(0, speed, level_end),
              by_bbsim(tilt, 0, tilted_end));
  for (const double step : {2e-3, 5e-4, 1e-4}) {
    char name[40];
    std::snprintf(name, sizeof name, "MuJoCo %g s", step);
    std::printf("%-16s %-24.9g %.9g\n", name, by_mujoco(0, speed, level_end, step),
                by_mujoco(tilt, 0, tilted_end, step));
  }
  return 0;
}
