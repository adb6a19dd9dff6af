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

}  // namespace bbsim::api
