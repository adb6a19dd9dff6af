// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/assemble.hpp"

#include <algorithm>
#include <cmath>

#include "base/number_text.hpp"

namespace bbsim::api {

model::Model assemble(const Scenario& scenario,
                      const std::vector<const scenario::Column*>& columns) {
  return with_places(scenario,
                     [&] { return model::assemble(scenario, scenario::integrals_for(columns)); });
}

model::Model assemble(const Scenario& scenario, const std::vector<const scenario::Column*>& columns,
                      controller::Host& host) {
  model::Model model = assemble(scenario, columns);
  with_places(scenario, [&] { host.attach(scenario, model); });
  return model;
}

controller::Host make_host(Watch& watch) {
  return controller::Host([&watch](std::string_view line) { watch.controller_says(line); },
                          watch.stop());
}

void try_controller(const ScenarioFamily& family, Scenario first, Watch& watch) {
  if (!first.controller || !first.controller->own) return;
  first.source = family.source();  // for the places of its keys
  controller::Host host = make_host(watch);
  static_cast<void>(assemble(first, scenario::columns_named(first.output.columns), host));
}

Sample copy_of(const model::ControllerSample& sample) {
  const auto& [x, y] = sample.reference;
  Sample copy{sample.number,      sample.t,         sample.seen,
              {x.value, y.value}, {x.rate, y.rate}, {x.acceleration, y.acceleration},
              sample.servo.size()};
  std::ranges::copy(sample.servo, copy.servo.begin());
  std::ranges::copy(sample.servo_rate, copy.servo_rate.begin());
  return copy;
}

void require_finite(const Pair& command) {
  if (std::isfinite(command[0]) && std::isfinite(command[1])) return;
  throw InputError("commands: found [" + number_text(command[0]) + ", " + number_text(command[1]) +
                   "]; allowed: finite numbers");
}

Scenario with_outside_commands(Scenario scenario) {
  if (!scenario.controller || !scenario.controller->sampling) {
    throw InputError(
        "controller.sampling: found none; allowed: {period: \"20 ms\"}, since commands from "
        "outside are given once per sample");
  }
  if (scenario.controller->drives == Drives::legs) {
    throw InputError(
        "controller.drives: found legs; allowed: angle, since commands from outside are for phi "
        "and theta");
  }
  scenario.controller->law = Law::own;
  scenario.controller->own.emplace();
  return scenario;
}

}  // namespace bbsim::api
