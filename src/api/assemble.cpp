// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/assemble.hpp"

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

}  // namespace bbsim::api
