// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "assemble.hpp"

#include <cstdio>
#include <string>

#include "base/error.hpp"
#include "scenario/look_up.hpp"
#include "terminal.hpp"

namespace bbsim::app {

namespace {

// Calls `make`; what is wrong with a key is thrown with its place.
template <class Make>
auto with_places(const Scenario& scenario, const Make& make) {
  try {
    return make();
  } catch (const KeyError& error) {
    throw InputError({Problem{place_of(scenario.source, error.key()), error.what()}});
  }
}

}  // namespace

model::Model assemble(const Scenario& scenario,
                      const std::vector<const scenario::Column*>& columns) {
  return with_places(scenario,
                     [&] { return model::assemble(scenario, scenario::need_gamma(columns)); });
}

model::Model assemble(const Scenario& scenario, const std::vector<const scenario::Column*>& columns,
                      controller::Host& host) {
  model::Model model = assemble(scenario, columns);
  attach(host, scenario, model);
  return model;
}

void attach(controller::Host& host, const Scenario& scenario, model::Model& model) {
  with_places(scenario, [&] { host.attach(scenario, model); });
}

void say_of_controller(std::string_view line) {
  // In the place of a progress bar, which is drawn again below it.
  if (draws_on_terminal()) std::fputs(to_clear_line, stderr);
  say("controller: " + std::string(line));
}

controller::Host make_host(const std::atomic<bool>* stop) {
  return controller::Host(say_of_controller, stop);
}

}  // namespace bbsim::app
