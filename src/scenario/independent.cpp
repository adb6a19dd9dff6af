// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "scenario/independent.hpp"

#include <string>
#include <utility>
#include <variant>

#include "scenario/coupled.hpp"
#include "yaml/spelling.hpp"

namespace bbsim {
namespace {

// Keys and the numbers that they set. A key may set several.
class Numbers {
 public:
  void add(const std::string& key, double& number) { all_.emplace_back(key, &number); }
  void add(const std::string& key, Pair& pair) {
    add(key + ".0", pair[0]);
    add(key + ".1", pair[1]);
  }
  void add(const std::string& key, Matrix2& matrix, bool as_number) {
    add(key + ".0", matrix[0]);
    add(key + ".1", matrix[1]);
    if (!as_number) return;
    add(key, matrix[0][0]);
    add(key, matrix[1][1]);
  }
  void add(const std::string& key, Profile& profile) {
    for (std::size_t i = 0; i < profile.size(); ++i) {
      if (profile.size() == 1) add(key, profile[i]);
      add(key + '.' + std::to_string(i), profile[i]);
    }
  }
  void add(const std::string& key, ProfileTerm& term) {
    if (auto* const constant = std::get_if<double>(&term)) {
      add(key, *constant);
    } else if (auto* const sinusoid = std::get_if<Sinusoid>(&term)) {
      add(key + ".sinusoid.amplitude", sinusoid->amplitude);
      add(key + ".sinusoid.frequency", sinusoid->frequency);
      add(key + ".sinusoid.phase", sinusoid->phase);
      add(key + ".sinusoid.offset", sinusoid->offset);
    } else if (auto* const ramp = std::get_if<Ramp>(&term)) {
      add(key + ".ramp.start", ramp->start);
      add(key + ".ramp.rate", ramp->rate);
    }
  }

  [[nodiscard]] std::vector<double*> of(const std::string& key) const {
    std::vector<double*> numbers;
    for (const auto& [name, number] : all_) {
      if (name == key) numbers.push_back(number);
    }
    return numbers;
  }

 private:
  std::vector<std::pair<std::string, double*>> all_;
};

void add_controller(Numbers& numbers, Controller& controller) {
  // The reader refuses a number as a gain that drives angles.
  const bool as_number = controller.drives != Drives::angle;
  numbers.add("controller.pd.kv", controller.kv, as_number);
  numbers.add("controller.pd.kp", controller.kp, as_number);
  if (auto* const point = std::get_if<PointReference>(&controller.reference)) {
    numbers.add("controller.reference.point", point->position);
  }
  if (auto* const circle = std::get_if<CircleReference>(&controller.reference)) {
    numbers.add("controller.reference.circle.center", circle->centre);
    numbers.add("controller.reference.circle.radius", circle->radius);
    numbers.add("controller.reference.circle.rate", circle->rate);
    numbers.add("controller.reference.circle.phase", circle->phase);
  }
}

// Whether the scene has no events, and prescribed motion or equation (31) with a plain servo.
bool is_plain(const Scenario& scenario) {
  if (bbsim::scenario::is_coupled(scenario) || scenario.ball.groove) return false;
  const Events& events = scenario.events;
  if (events.edge || events.slip || events.lift_off || events.tilt || events.singularity) {
    return false;
  }
  if (!scenario.controller) return true;
  const Gimbal& gimbal = scenario.gimbal;
  if (bbsim::scenario::is_linked(scenario) || gimbal.theta_servo) return false;
  const Controller& controller = *scenario.controller;
  return controller.law == Law::pd && !controller.limit && !controller.axis_limits &&
         !controller.sampling && (!gimbal.servo || gimbal.servo->plain());
}

}  // namespace

std::vector<double*> independent_number(Scenario& scenario, std::string_view key) {
  if (!is_plain(scenario)) return {};
  Numbers numbers;
  numbers.add("gravity", scenario.gravity);
  numbers.add("ball.position", scenario.ball.position);
  numbers.add("ball.velocity", scenario.ball.velocity);
  numbers.add("ball.radius", scenario.ball.radius);
  numbers.add("ball.mass", scenario.ball.mass);
  numbers.add("ball.spin", scenario.ball.spin);
  Gimbal& gimbal = scenario.gimbal;
  if (gimbal.motion) {
    numbers.add("gimbal.motion.phi", gimbal.motion->phi);
    numbers.add("gimbal.motion.theta", gimbal.motion->theta);
  }
  numbers.add("gimbal.start.phi", gimbal.start.phi);
  numbers.add("gimbal.start.theta", gimbal.start.theta);
  numbers.add("gimbal.start.phi_rate", gimbal.start.phi_rate);
  numbers.add("gimbal.start.theta_rate", gimbal.start.theta_rate);
  if (gimbal.servo) {
    numbers.add("gimbal.servo.natural_frequency", gimbal.servo->natural_frequency);
    numbers.add("gimbal.servo.damping", gimbal.servo->damping);
  }
  if (scenario.controller) add_controller(numbers, *scenario.controller);
  return numbers.of(yaml::american(key));
}

}  // namespace bbsim
