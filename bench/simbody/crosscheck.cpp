// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Compares equation (27) with a multibody engine that derives its own equations.
//
// Simbody (Sherman, Seth and Delp 2011) gets two pins, a plate, a free ball and its ideal
// sphere-on-plane constraint with rolling, and integrates its own equations of motion. The pins are
// prescribed or driven by torques. The angles and the paths of the contact point are compared.
//
//     crosscheck SCENARIO.yaml...    open loops and given torques; prints the largest differences
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <stdexcept>

#include "model/model.hpp"
#include "rig.hpp"
#include "scenario/reader.hpp"
#include "solve/integrate.hpp"

namespace {

struct Differences {
  double position = 0;  // of x and y at the worst output time, m
  double angle = 0;     // of phi and theta, rad
  double extent = 0;    // the largest coordinate, m
  double tilt = 0;      // the largest angle, rad
};

crosscheck::Driven driven_by(const bbsim::Scenario& scene,
                             const bbsim::model::SignalPair& torques) {
  const bbsim::Plate& plate = scene.plate;
  const bbsim::Gimbal& gimbal = scene.gimbal;
  crosscheck::Driven driven;
  driven.plate_inertia = plate.inertia.value();
  driven.plate_mass = plate.mass;
  driven.centre_of_mass = plate.centre_of_mass;
  driven.ring_inertia = gimbal.ring_inertia;
  if (gimbal.motor) {
    if (gimbal.motor->friction > 0) throw std::runtime_error("dry friction is not compared");
    driven.rotor_inertia = gimbal.motor->rotor_inertia;
    driven.viscous = gimbal.motor->viscous;
  }
  driven.angles = {gimbal.start.phi, gimbal.start.theta};
  driven.rates = {gimbal.start.phi_rate, gimbal.start.theta_rate};
  driven.torque = [&torques](double t, int axis) {
    return torques.at(t)[static_cast<std::size_t>(axis)].value;
  };
  return driven;
}

Differences compare(const bbsim::Scenario& scene) {
  const auto& given = scene.gimbal.motion ? scene.gimbal.motion : scene.gimbal.torque;
  if (!given) throw std::runtime_error("neither an open loop nor one of given torques");
  bbsim::model::SignalPair motion;
  motion.add(0, given->phi);
  motion.add(1, given->theta);

  const bbsim::model::Model model = bbsim::model::assemble(scene, false);
  const bbsim::solve::OutputGrid grid(scene.time);
  bbsim::solve::Trajectory rows(model.row_size());
  const auto outcome =
      bbsim::solve::integrate(model, bbsim::Method::automatic, {1e-13, 1e-15}, grid, rows);
  if (outcome.ending != bbsim::solve::Ending::done) throw std::runtime_error(outcome.reason);

  std::vector<double> times;
  for (std::size_t i = 0; i < grid.size(); ++i) times.push_back(grid[i]);
  const bbsim::Ball& ball = scene.ball;
  const auto angle = [&](double t, int axis, int order) {
    const auto jet = motion.at(t)[static_cast<std::size_t>(axis)];
    return order == 0 ? jet.value : order == 1 ? jet.rate : jet.acceleration;
  };
  crosscheck::Rig rig{ball.radius,   ball.mass, scene.gravity, ball.position,
                      ball.velocity, ball.spin, angle};
  if (scene.gimbal.torque) rig.driven = driven_by(scene, motion);
  const auto path = crosscheck::simulate(rig, times);

  Differences differences;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const bbsim::model::Sample ours = model.sample(times[i], rows.row(i));
    const auto& [x, y, phi, theta] = path[i];
    differences.position =
        std::max({differences.position, std::abs(x - ours.ball.x), std::abs(y - ours.ball.y)});
    differences.angle = std::max(
        {differences.angle, std::abs(phi - ours.gimbal.phi), std::abs(theta - ours.gimbal.theta)});
    differences.extent =
        std::max({differences.extent, std::abs(ours.ball.x), std::abs(ours.ball.y)});
    differences.tilt =
        std::max({differences.tilt, std::abs(ours.gimbal.phi), std::abs(ours.gimbal.theta)});
  }
  return differences;
}

}  // namespace

int main(int argc, char** argv) {
  std::printf("%-24s %-11s %-11s %-15s %s\n", "scenario", "extent (m)", "tilt (rad)",
              "difference (m)", "(rad)");
  for (int i = 1; i < argc; ++i) {
    try {
      const Differences differences = compare(bbsim::read_scenario(argv[i]));
      std::printf("%-24s %-11.4g %-11.4g %-15.1e %.1e\n", argv[i], differences.extent,
                  differences.tilt, differences.position, differences.angle);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s: %s\n", argv[i], error.what());
      return 1;
    }
  }
  return 0;
}
