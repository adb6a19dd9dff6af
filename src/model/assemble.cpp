// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Makes a Model from a Scenario (model.hpp): chooses the system, its states and its stops.
#include "model/assemble.hpp"

#include <algorithm>
#include <utility>

#include "base/instant.hpp"
#include "model/servo/linkages.hpp"
#include "model/signals/signal_pair.hpp"
#include "scenario/coupled.hpp"

namespace bbsim::model {
namespace {

// Whether the scene needs a system of coupled.hpp.
bool needs_coupled(const Scenario& scene) {
  return scenario::is_coupled(scene) || scenario::is_linked(scene);
}

bool zero_row(const Controller& controller, std::size_t row) {
  const auto zero = [row](const Matrix2& gain) { return gain[row] == Pair{0, 0}; };
  return zero(controller.kv) && zero(controller.kp);
}

// Whether a gimbal angle (0: phi, 1: theta) is zero at all times.
bool stays_level(const Scenario& scene, const SignalPair& input, std::size_t axis) {
  if (!scene.controller) return input.is_zero(axis);
  const GimbalStart& start = scene.gimbal.start;
  const bool at_zero =
      axis == 0 ? start.phi == 0 && start.phi_rate == 0 : start.theta == 0 && start.theta_rate == 0;
  return at_zero && zero_row(*scene.controller, axis);
}

// The symmetries of docs/explanation/model.md, "Structure": theta, y and the spin stay zero
// together, or phi, x and the spin.
Shape choose_shape(const Scenario& scene, const SignalPair& input) {
  if (needs_rig(scene) || needs_coupled(scene) || !is_the_papers(scene)) return Shape::full;
  const Ball& ball = scene.ball;
  const auto at_rest = [&ball](std::size_t axis) {
    return ball.position[axis] == 0 && ball.velocity[axis] == 0;
  };
  if (ball.spin != 0) return Shape::full;
  if (stays_level(scene, input, 1) && at_rest(1)) return Shape::along_x;
  if (stays_level(scene, input, 0) && at_rest(0)) return Shape::along_y;
  return Shape::full;
}

template <Drives drives>
System closed_loop(Shape shape, const Scenario& scene, SignalPair path) {
  const Controller& controller = *scene.controller;
  Gains gains{};
  for (std::size_t row = 0; row < 2; ++row) {
    for (std::size_t column = 0; column < 2; ++column) {
      gains.kv[row][column] = controller.kv[row][column];
      gains.kp[row][column] = controller.kp[row][column];
    }
  }
  ServoLaw servo{};
  if (scene.gimbal.servo) {
    servo = {scene.gimbal.servo->natural_frequency, scene.gimbal.servo->damping};
  }
  const double r = scene.ball.radius, g = scene.gravity;
  switch (shape) {
    case Shape::along_x:
      return ClosedLoop<Shape::along_x, drives>(r, g, gains, servo, std::move(path));
    case Shape::along_y:
      return ClosedLoop<Shape::along_y, drives>(r, g, gains, servo, std::move(path));
    case Shape::full:
      break;
  }
  return ClosedLoop<Shape::full, drives>(r, g, gains, servo, std::move(path));
}

System open_loop(Shape shape, const Scenario& scene, SignalPair motion) {
  const double r = scene.ball.radius, g = scene.gravity;
  switch (shape) {
    case Shape::along_x:
      return OpenLoop<Shape::along_x>(r, g, std::move(motion));
    case Shape::along_y:
      return OpenLoop<Shape::along_y>(r, g, std::move(motion));
    case Shape::full:
      break;
  }
  return OpenLoop<Shape::full>(r, g, std::move(motion));
}

// In the system's layout. Three servos start at home; all states after the angles' rates at zero.
template <class AnySystem>
std::vector<double> initial_state(const Scenario& scene, const AnySystem& /*system*/) {
  constexpr bool phi = phi_moves(AnySystem::moves), theta = theta_moves(AnySystem::moves);
  const Ball& ball = scene.ball;
  const GimbalStart& start = scene.gimbal.start;
  std::vector<double> z;
  if (phi) z.push_back(ball.position[0]);
  if (theta) z.push_back(ball.position[1]);
  if (phi) z.push_back(ball.velocity[0]);
  if (theta) z.push_back(ball.velocity[1]);
  if (phi && theta) z.push_back(ball.radius * ball.spin);
  constexpr bool given =
      AnySystem::open_loop || (is_coupled<AnySystem> && !is_coupled_loop<AnySystem>);
  if (!given && !scene.gimbal.three_servos) {
    if (phi) z.push_back(start.phi);
    if (theta) z.push_back(start.theta);
    if (phi) z.push_back(start.phi_rate);
    if (theta) z.push_back(start.theta_rate);
  }
  z.resize(AnySystem::size, 0.0);
  if constexpr (is_coupled<AnySystem>) {
    constexpr std::size_t slip = AnySystem::Layout::slip;
    if (ball.rotation) {
      z[slip] = ball.velocity[0] - ball.radius * (*ball.rotation)[1];
      z[slip + 1] = ball.velocity[1] + ball.radius * (*ball.rotation)[0];
    }
  }
  return z;
}

// The integrator's stops: the sorted knots within the run. Knots that differ only by rounding make
// one stop, because there is nothing to integrate between them.
std::vector<double> stops_at(const std::vector<double>& knots, double end) {
  std::vector<double> stops;
  double last = 0;
  for (const double t : knots) {
    if (t - last <= rounding_of(t)) continue;
    if (end - t <= rounding_of(end)) break;
    stops.push_back(t);
    last = t;
  }
  return stops;
}

}  // namespace

Model assemble(const Scenario& scenario, scenario::Integrals integrals, Form form) {
  // The gimbal's angles or torques if prescribed; otherwise the controller's reference.
  SignalPair input;
  if (scenario.controller) {
    input = reference_path(scenario.controller->reference, scenario.time.end);
  } else if (scenario.gimbal.motion) {
    input = given_motion(scenario);
  } else if (scenario.gimbal.torque) {
    input.add(0, scenario.gimbal.torque->phi);
    input.add(1, scenario.gimbal.torque->theta);
  }
  std::vector<double> knots = input.knots();
  if (scenario.ball.push) {
    const std::vector<double> more = push_knots(scenario);
    knots.insert(knots.end(), more.begin(), more.end());
    std::ranges::sort(knots);
  }
  std::vector<double> stops = stops_at(knots, scenario.time.end);
  std::vector<double> jumps = stops_at(input.knots(true), scenario.time.end);
  const Shape shape = form == Form::reduced ? choose_shape(scenario, input) : Shape::full;

  std::optional<Rig> rig;
  std::optional<DryParts> dry;
  const auto build = [&]() -> System {
    const double r = scenario.ball.radius, g = scenario.gravity;
    if (needs_coupled(scenario)) {
      CoupledScene coupled = assemble_coupled(scenario, std::move(input));
      rig = coupled.rig;
      dry = coupled.dry;
      return std::move(coupled.system);
    }
    if (needs_rig(scenario)) {
      const auto keep = [&rig](auto built) -> System {
        rig = built.rig;
        return std::move(built.loop);
      };
      return integrates_error(scenario) ? keep(assemble_rig<true>(scenario, std::move(input)))
                                        : keep(assemble_rig<false>(scenario, std::move(input)));
    }
    if (!scenario.controller) {
      if (!is_the_papers(scenario)) {
        return OpenLoop<Shape::full, SignalPair, GeneralRolling>(r, g, std::move(input),
                                                                 general_rolling(scenario));
      }
      return open_loop(shape, scenario, std::move(input));
    }
    if (scenario.controller->drives == Drives::angle) {
      return closed_loop<Drives::angle>(shape, scenario, std::move(input));
    }
    return closed_loop<Drives::acceleration>(shape, scenario, std::move(input));
  };
  System system = build();
  std::vector<double> initial =
      std::visit([&](const auto& any) { return initial_state(scenario, any); }, system);
  Model model{std::move(system),
              std::move(initial),
              integrals.gamma && shape == Shape::full,
              scenario.ball.radius,
              std::move(stops),
              rig,
              {},
              dry,
              std::move(jumps),
              integrals.work};
  EventMonitors events = event_monitors(scenario);
  if (!events.monitors.empty()) model.events = std::move(events);
  return model;
}

}  // namespace bbsim::model
