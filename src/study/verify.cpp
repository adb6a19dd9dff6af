// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "study/verify.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <iterator>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/real.hpp"
#include "model/ball/dynamics.hpp"
#include "model/model.hpp"
#include "scenario/reader.hpp"
#include "solve/choose.hpp"
#include "solve/output_grid.hpp"
#include "study/verify_coupled.hpp"
#include "study/verify_linkages.hpp"
#include "study/verify_references.hpp"
#include "study/whole_run.hpp"

namespace bbsim::study {
namespace {

using model::Sample;

// For BDF and Adams. Their orders of at most 5 and 12 make finer tolerances expensive.
constexpr solve::Tolerances of_multistep{1e-9, 1e-11};

// The values at one instant: x, y, r gamma in m, u in m/s.
struct Expected {
  double x = 0, y = 0, u = 0, turned = 0;  // turned: r gamma
};

Expected values(const Sample& sample, double r) {
  return {sample.ball.x, sample.ball.y, r * sample.ball.gamma_dot, r * sample.gamma};
}

double distance(const Expected& a, const Expected& b) {
  const std::array<double, 4> differences{a.x - b.x, a.y - b.y, a.u - b.u, a.turned - b.turned};
  double largest = 0;
  for (const double difference : differences) {
    if (std::isnan(difference)) return infinity;
    largest = larger(largest, std::abs(difference));
  }
  return largest;
}

double largest_distance(const WholeRun& run, double r,
                        const std::function<Expected(std::size_t)>& expected) {
  if (!run.done) return infinity;
  double largest = 0;
  for (std::size_t i = 0; i < run.samples.size(); ++i) {
    largest = larger(largest, distance(values(run.samples[i], r), expected(i)));
  }
  return largest;
}

Scenario incline() {
  Scenario scene;
  scene.ball = {
      .radius = 0.01, .mass = 0.1, .position = {0.1, -0.2}, .velocity = {0.3, 0.4}, .spin = 20};
  scene.gimbal.motion = {{0.2}, {-0.3}};
  scene.time = {3, 0.1};
  return scene;
}

// Uses all terms of equation (27): both angles move, at different rates, and the ball rolls and
// spins.
Scenario everything_moves() {
  Scenario scene;
  scene.ball = {
      .radius = 0.02, .mass = 0.1, .position = {0.1, -0.05}, .velocity = {0.2, 0.1}, .spin = 30};
  scene.gimbal.motion = {{Sinusoid{0.2, 3, 1, 0.01}}, {Sinusoid{0.15, 2, 0, 0}, Ramp{0, 0.02}}};
  scene.time = {5, 0.05};
  return scene;
}

Check fixed_incline(const solve::Watch& watch) {
  const Scenario scene = incline();
  const WholeRun made = whole_run(scene, watch);
  const double g = scene.gravity, r = scene.ball.radius;
  const double error = largest_distance(made, r, [&](std::size_t i) -> Expected {
    const double t = made.samples[i].t;
    return {0.1 + 0.3 * t + 5.0 / 14 * g * std::sin(0.2) * t * t,
            -0.2 + 0.4 * t - 5.0 / 14 * g * std::cos(0.2) * std::sin(-0.3) * t * t, r * 20,
            r * 20 * t};
  });
  return {"fixed incline: closed form (M1)", error, made.allowance, "m"};
}

Check turning_plane(const solve::Watch& watch) {
  const double w = 2, x0 = 0.05, vy0 = 0.1, spin0 = 5;
  Scenario scene;
  scene.ball = {.radius = 0.01, .position = {x0, 0}, .velocity = {0, vy0}, .spin = spin0};
  scene.gimbal.motion = {{Ramp{0, w}}, {}};
  scene.time = {3, 0.1};
  const WholeRun made = whole_run(scene, watch);
  const double g = scene.gravity, r = scene.ball.radius;
  const double k = w * std::sqrt(5.0 / 7), q = w * std::sqrt(2.0 / 7);
  const double b = 5 * g / (12 * w * k);  // makes x'(0) zero
  const double c = r * spin0 * w * (2.0 / 7) / q;
  const double error = largest_distance(made, r, [&](std::size_t i) -> Expected {
    const double t = made.samples[i].t;
    // (M3) integrated: y from y', and u' = -w y' from the third row of (27).
    const double y = (vy0 * std::sin(q * t) + c * (1 - std::cos(q * t))) / q;
    const double integral_of_y =
        (vy0 * (1 - std::cos(q * t)) / q + c * (t - std::sin(q * t) / q)) / q;
    return {x0 * std::cosh(k * t) + b * std::sinh(k * t) - 5 * g / (12 * w * w) * std::sin(w * t),
            y, r * spin0 - w * y, r * spin0 * t - w * integral_of_y};
  });
  return {"plane turning at a constant rate: closed forms (M2), (M3)", error, made.allowance, "m"};
}

// The symmetries of docs/explanation/model.md, "Structure". Axis 0 mirrors x and phi, axis 1
// mirrors y and theta.
Check mirrored(std::size_t axis, const solve::Watch& watch) {
  const Scenario scene = everything_moves();
  Scenario mirror = scene;
  mirror.ball.position[axis] *= -1;
  mirror.ball.velocity[axis] *= -1;
  mirror.ball.spin *= -1;
  if (axis == 0) {
    mirror.gimbal.motion->phi = {Sinusoid{-0.2, 3, 1, -0.01}};
  } else {
    mirror.gimbal.motion->theta = {Sinusoid{-0.15, 2, 0, 0}, Ramp{0, -0.02}};
  }
  const double r = scene.ball.radius;
  const WholeRun a = whole_run(scene, watch), b = whole_run(mirror, watch);
  const double error = !b.done ? infinity : largest_distance(a, r, [&](std::size_t i) -> Expected {
    const Expected seen = values(b.samples[i], r);
    return {axis == 0 ? -seen.x : seen.x, axis == 1 ? -seen.y : seen.y, -seen.u, -seen.turned};
  });
  return {axis == 0 ? "mirror symmetry in x, phi, gamma" : "mirror symmetry in y, theta, gamma",
          error, a.allowance + b.allowance, "m"};
}

Check scaled(const solve::Watch& watch) {
  const Scenario scene = everything_moves();
  // Not powers of two, whose products would be exact.
  const double l = 3, t = std::sqrt(l);
  Scenario larger = scene;
  larger.ball.radius *= l;
  for (double& value : larger.ball.position) value *= l;
  for (double& value : larger.ball.velocity) value *= l / t;
  larger.ball.spin /= t;
  larger.gimbal.motion = {{Sinusoid{0.2, 3 / t, 1, 0.01}},
                          {Sinusoid{0.15, 2 / t, 0, 0}, Ramp{0, 0.02 / t}}};
  larger.time = {scene.time.end * t, scene.time.step * t};
  const double r = scene.ball.radius;
  const WholeRun a = whole_run(scene, watch), b = whole_run(larger, watch);
  const bool alike = b.done && a.samples.size() == b.samples.size();
  const double error = !alike ? infinity : largest_distance(a, r, [&](std::size_t i) -> Expected {
    const Expected seen = values(b.samples[i], l * r);
    return {seen.x / l, seen.y / l, seen.u / (l / t), seen.turned / l};
  });
  return {"lengths by 3, times by sqrt(3)", error, a.allowance + b.allowance / l, "m"};
}

struct Instant {
  double energy, power;  // J, W
};

std::vector<Instant> energies(const WholeRun& made, const Scenario& scene) {
  const model::BallConstants constants = model::constants_of(scene);
  std::vector<Instant> list;
  for (const Sample& sample : made.samples) {
    const model::Dynamics at = model::dynamics(sample, constants);
    list.push_back({at.energy(), at.torque_phi * sample.gimbal.phi_dot +
                                     at.torque_theta * sample.gimbal.theta_dot});
  }
  return list;
}

// The effect of an error of the allowance in each state on the energy and on the work until then.
// Forces are about m (g + v / 1 s), momenta m v, and the plate's rates below 1 rad/s.
double energy_allowance(const WholeRun& made, const Scenario& scene) {
  return 2 * scene.ball.mass * (scene.gravity + made.size) * made.allowance * (1 + scene.time.end);
}

Check energy_conserved(const solve::Watch& watch) {
  const Scenario scene = incline();
  const WholeRun made = whole_run(scene, watch);
  double error = made.done ? 0 : infinity;
  const std::vector<Instant> instants = energies(made, scene);
  for (const Instant& instant : instants) {
    error = larger(error, std::abs(instant.energy - instants.front().energy));
  }
  return {"fixed incline: energy is conserved", error, energy_allowance(made, scene), "J"};
}

// Boole's rule over rows 0, stride, 2 stride ... at distance h. Returns the running value after
// each panel of four.
std::vector<double> work_by_boole(const std::vector<Instant>& instants, std::size_t stride,
                                  double h) {
  std::vector<double> work{0};
  for (std::size_t i = 0; i + 4 * stride < instants.size(); i += 4 * stride) {
    const auto power = [&](std::size_t k) { return instants[i + k * stride].power; };
    work.push_back(
        work.back() +
        2 * h / 45 * (7 * power(0) + 32 * power(1) + 12 * power(2) + 32 * power(3) + 7 * power(4)));
  }
  return work;
}

Check energy_balance(const solve::Watch& watch) {
  Scenario scene = everything_moves();
  constexpr double h = 1.0 / 256;
  scene.time.step = h;
  const WholeRun made = whole_run(scene, watch);
  const std::vector<Instant> instants = energies(made, scene);
  const std::vector<double> fine = work_by_boole(instants, 1, h);
  const std::vector<double> coarse = work_by_boole(instants, 2, 2 * h);
  double error = made.done ? 0 : infinity;
  double quadrature = 0;
  for (std::size_t i = 0; i < coarse.size(); ++i) {
    const double gained = instants[8 * i].energy - instants.front().energy;
    error = larger(error, std::abs(gained - fine[2 * i]));
    quadrature = larger(quadrature, std::abs(coarse[i] - fine[2 * i]));
  }
  // Half the step divides the error of Boole's rule by 64. The difference is thus the error of the
  // coarse one, and more than that of the fine one.
  return {"moving plane: energy gained is the motors' work", error,
          energy_allowance(made, scene) + quadrature, "J"};
}

Scenario scenario_of(const ReferenceScene& reference) {
  return parse_scenario(reference.scenario, std::string(reference.name) + ".yaml");
}

Check against_reference(const ReferenceScene& reference, const solve::Watch& watch) {
  const Scenario scene = scenario_of(reference);
  const double r = scene.ball.radius;
  const WholeRun made = whole_run(scene, watch);
  double error = made.done ? 0 : infinity;
  for (const ReferenceRow& row : reference.rows) {
    const auto i = static_cast<std::size_t>(std::lround(row.t / scene.time.step));
    if (i >= made.samples.size()) break;
    error = larger(
        error, distance(values(made.samples[i], r), {row.x, row.y, r * row.spin, r * row.gamma}));
  }
  return {std::string(reference.name) + ": quad-precision reference", error, made.allowance, "m"};
}

Check against_method(const ReferenceScene& reference, Method method, const solve::Watch& watch) {
  const Scenario scene = scenario_of(reference);
  const double r = scene.ball.radius;
  const WholeRun a = whole_run(scene, watch, Method::radau),
                 b = whole_run(scene, watch, method, of_multistep);
  const double error =
      !b.done ? infinity
              : largest_distance(a, r, [&](std::size_t i) { return values(b.samples[i], r); });
  return {
      std::string(reference.name) + ": radau against " + std::string(solve::method_name(method)),
      error, a.allowance + b.allowance, "m"};
}

}  // namespace

bool Verification::holds() const {
  return !interrupted && std::ranges::all_of(checks, &Check::holds);
}

Verification verify(const solve::Watch& watch) {
  std::vector<std::function<Check()>> all{
      [&] { return fixed_incline(watch); },  [&] { return turning_plane(watch); },
      [&] { return mirrored(0, watch); },    [&] { return mirrored(1, watch); },
      [&] { return scaled(watch); },         [&] { return energy_conserved(watch); },
      [&] { return energy_balance(watch); },
  };
  std::ranges::copy(coupled_checks(watch), std::back_inserter(all));
  std::ranges::copy(linkage_checks(), std::back_inserter(all));
  for (const ReferenceScene& reference : reference_scenes) {
    all.emplace_back([&] { return against_reference(reference, watch); });
  }
  for (const ReferenceScene& reference : reference_scenes) {
    for (const Method method : {Method::bdf, Method::adams}) {
      // Adams would take half a million steps for the fast servo.
      if (method == Method::adams && reference.name == std::string("stiff-servo")) continue;
      all.emplace_back(
          [&reference, method, &watch] { return against_method(reference, method, watch); });
    }
  }
  Verification made;
  for (const auto& check : all) {
    Check result = check();
    if (watch.stop != nullptr && watch.stop->load(std::memory_order_relaxed)) {
      made.interrupted = true;
      break;
    }
    made.checks.push_back(std::move(result));
    if (watch.progress) {
      watch.progress(static_cast<double>(made.checks.size()) / static_cast<double>(all.size()));
    }
  }
  return made;
}

}  // namespace bbsim::study
