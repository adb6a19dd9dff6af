// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "study/verify_coupled.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "base/real.hpp"
#include "model/ball/dynamics.hpp"
#include "model/model.hpp"
#include "model/servo/linkages.hpp"
#include "study/verify_linkages.hpp"
#include "study/whole_run.hpp"

namespace bbsim::study {
namespace {

using model::Sample;

// The largest distance of `value` from `expected`; infinite for an incomplete run.
double distance(const WholeRun& made, double (*value)(const Sample&),
                const std::function<double(double)>& expected) {
  double largest = made.done ? 0 : infinity;
  for (const Sample& sample : made.samples) {
    largest = larger(largest, std::abs(value(sample) - expected(sample.t)));
  }
  return largest;
}

double x_of(const Sample& sample) {
  return sample.ball.x;
}

Scenario level_plate() {
  Scenario scene;
  scene.ball.radius = 0.02;
  scene.ball.mass = 0.05;
  scene.gimbal.motion = GimbalMotion{};
  scene.time = {10, 0.1};
  return scene;
}

Check coasts_down(const solve::Watch& watch) {
  Scenario scene = level_plate();
  scene.ball.velocity = {0.2, 0};
  scene.ball.losses.rolling = 0.004;
  const WholeRun made = whole_run(scene, watch);
  const double a = 0.004 * scene.gravity / 1.4, stop = 0.2 / a;
  const double error = distance(made, x_of, [&](double t) {
    const double rolled = std::min(t, stop);
    return 0.2 * rolled - a * rolled * rolled / 2;
  });
  return {"rolling resistance: coasts down and stays (M41)", error, made.allowance, "m"};
}

Check starts_on_an_incline(const solve::Watch& watch) {
  Scenario scene = level_plate();
  const double c = 0.004;
  scene.ball.losses.rolling = c;
  scene.time = {1000, 10};
  scene.gimbal.motion->phi = {std::atan(c * (1 - 1e-12))};
  const WholeRun below = whole_run(scene, watch);
  scene.gimbal.motion->phi = {std::atan(c * (1 + 1e-12))};
  const WholeRun above = whole_run(scene, watch);
  const bool right = below.done && above.done && below.samples.back().ball.x == 0 &&
                     above.samples.back().ball.x > 0;
  return {"rolling resistance: starts at tan(tilt) = c_rr", right ? 1e-12 : 1, 1e-12, "1"};
}

Check spins_down(const solve::Watch& watch) {
  Scenario scene = level_plate();
  scene.ball.spin = 20;
  scene.ball.losses.pivoting = 1e-4;
  const WholeRun made = whole_run(scene, watch);
  const double r = scene.ball.radius, a = 1e-4 * scene.gravity / (0.4 * r * r), stop = 20 / a;
  const double error = r * distance(
                               made, [](const Sample& s) { return s.gamma; },
                               [&](double t) {
                                 const double turned = std::min(t, stop);
                                 return 20 * turned - a * turned * turned / 2;
                               });
  return {"pivoting friction: spins down and stays", error, made.allowance, "m"};
}

Check decays(const solve::Watch& watch) {
  Scenario scene = level_plate();
  scene.ball.velocity = {0.2, 0};
  scene.ball.losses.viscous = 5e-6;
  const WholeRun made = whole_run(scene, watch);
  const double rate = 5e-6 / (1.4 * 0.05 * 0.02 * 0.02);
  const double error =
      distance(made, x_of, [&](double t) { return 0.2 / rate * (1 - std::exp(-rate * t)); });
  return {"viscous loss: decays", error, made.allowance, "m"};
}

Check slides_to_roll(double backspin, const solve::Watch& watch) {
  Scenario scene = level_plate();
  scene.ball.velocity = {1, 0};
  scene.ball.rotation = Pair{0, backspin};
  scene.events.slip = SlipEvent{0.3, OnEvent::note, 0.25};
  scene.time = {2, 0.02};
  const WholeRun made = whole_run(scene, watch);
  const double k = 0.4, a = 0.25 * scene.gravity, slip = 1 - 0.02 * backspin;
  const double rolls = k * slip / ((1 + k) * a);
  const double error = distance(made, x_of, [&](double t) {
    const double slid = std::min(t, rolls);
    return slid - a * slid * slid / 2 + (t - slid) * (1 + k * 0.02 * backspin) / (1 + k);
  });
  return {backspin == 0 ? "sliding: rolls after 2v/(7 mu g), with 5v/7"
                        : "sliding: backspin takes its part of the speed",
          error, made.allowance, "m"};
}

// Checks that the energy of all moving parts, plus losses, minus the motors' work, is constant. The
// integrals are states under the same tolerance, so their allowed error is the allowance in joules.
// The energy's is that of the states times the forces, momenta and moments of the scene.
Check balance(const char* name, const Scenario& scene, const solve::Watch& watch) {
  const WholeRun made = whole_run(scene, watch);
  const model::BallConstants constants = model::constants_of(scene);
  double error = made.done ? 0 : infinity, first = 0;
  for (std::size_t i = 0; i < made.samples.size(); ++i) {
    const model::Dynamics now = model::dynamics(made.samples[i], constants);
    const double sum = now.energy() + now.gimbal_energy + now.coupled.lost - now.coupled.work;
    if (i == 0) first = sum;
    error = larger(error, std::abs(sum - first));
  }
  const double weight = (scene.ball.mass + scene.plate.mass) * scene.gravity;
  return {name, error, (2 + weight) * made.allowance, "J"};
}

Check swings(const solve::Watch& watch) {
  Scenario scene = level_plate();
  scene.ball.position = {0.03, -0.02};
  scene.ball.losses = {0.002, 1e-6, 1e-4};
  scene.ball.spin = 5;
  scene.plate.inertia = {4e-3, 6e-3, 1e-2};
  scene.plate.mass = 0.5;
  scene.plate.centre_of_mass = -0.05;
  scene.gimbal.motion.reset();
  scene.gimbal.torque = GimbalMotion{{Sinusoid{0.02, 3, 1, 0}}, {Sinusoid{0.015, 4, 0, 0}}};
  scene.gimbal.ring_inertia = 2e-3;
  scene.gimbal.motor = Motor{1e-3, 0.01, 0.005, {}, {}, {}};
  scene.time = {3, 0.02};
  return balance("torques, dry friction: energy, work and losses balance", scene, watch);
}

Check rocks(const solve::Watch& watch) {
  Scenario scene = level_plate();
  scene.ball.losses.rolling = 0.003;
  scene.gimbal.motion->phi = {Sinusoid{0.2, 7, std::numbers::pi / 2, 0}};
  scene.gimbal.motion->theta = {Sinusoid{0.15, 5, std::numbers::pi / 2, 0}};
  scene.events.slip = SlipEvent{0.055, OnEvent::note, 0.045};
  scene.time = {3, 0.02};
  return balance("sliding and rolling by turns: energy, work and losses balance", scene, watch);
}

Scenario linked_plate() {
  Scenario scene = level_plate();
  scene.gimbal.motion.reset();
  scene.gimbal.linkage = {push_rod(), push_rod()};
  scene.gimbal.servo = Servo{30, 0.8};
  Controller controller;
  controller.drives = Drives::angle;
  controller.assumes = Assumes::exact;
  scene.controller = controller;
  return scene;
}

// A first-order servo with command 0 starts at its rate limit. It follows an exponential from the
// angle at which its time constant gives that rate.
Check ramps_behind_a_rod(const solve::Watch& watch) {
  const double start = 0.5, fastest = 0.8, constant = 0.05;
  Scenario scene = linked_plate();
  scene.gimbal.servo = Servo{};
  scene.gimbal.servo->time_constant = constant;
  scene.gimbal.servo->rate_limit = fastest;
  scene.gimbal.start.phi = start;
  scene.time = {1.5, 0.01};
  const WholeRun made = whole_run(scene, watch);
  const model::Linkage rod = make_linkage(push_rod(), model::Assumed::exact);
  const double left = fastest * constant, at = (start - left) / fastest;
  const double error = distance(
      made, [](const Sample& s) { return s.gimbal.phi; },
      [&](double t) {
        return rod.angle(t < at ? start - fastest * t : left * std::exp(-(t - at) / constant));
      });
  return {"push rod: a servo's ramp, and its end, through the curve", error, made.allowance, "rad"};
}

// Plate and ball receive an impulse when gears engage. The servo does its work.
Check strikes(const solve::Watch& watch) {
  Scenario scene = linked_plate();
  scene.ball.position = {0.05, -0.03};
  scene.plate.inertia = {1e-3, 2e-3, 3e-3};
  scene.gimbal.servo->backlash = 0.02;
  scene.controller->kp = {{{1, 0}, {0, -1}}};
  scene.controller->kv = {{{0.8, 0}, {0, -0.8}}};
  scene.controller->reference = CircleReference{0.05, 1.5, 0};
  scene.time = {3, 0.02};
  return balance("push rods with backlash: energy and the servos' work balance", scene, watch);
}

}  // namespace

std::vector<std::function<Check()>> coupled_checks(const solve::Watch& watch) {
  return {[&] { return coasts_down(watch); },
          [&] { return starts_on_an_incline(watch); },
          [&] { return spins_down(watch); },
          [&] { return decays(watch); },
          [&] { return slides_to_roll(0, watch); },
          [&] { return slides_to_roll(-40, watch); },
          [&] { return swings(watch); },
          [&] { return rocks(watch); },
          [&] { return ramps_behind_a_rod(watch); },
          [&] { return strikes(watch); }};
}

}  // namespace bbsim::study
