// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Builds the model of a scenario; errors about a key name its place.
#pragma once

#include <vector>

#include "api/watch.hpp"
#include "base/error.hpp"
#include "controller/host.hpp"
#include "model/model.hpp"
#include "scenario/columns.hpp"
#include "scenario/family.hpp"
#include "scenario/reader.hpp"

namespace bbsim::api {

// Calls `make`; turns a KeyError into an InputError with the key's place in the scenario.
template <class Make>
auto with_places(const Scenario& scenario, const Make& make) {
  try {
    return make();
  } catch (const KeyError& error) {
    throw InputError({Problem{place_of(scenario.source, error.key()), error.what()}});
  }
}

// Model that these columns need, for inspection only. Throws InputError.
[[nodiscard]] model::Model assemble(const Scenario& scenario,
                                    const std::vector<const scenario::Column*>& columns);

// The same for a run: starts the user's controller, if the scene has one.
[[nodiscard]] model::Model assemble(const Scenario& scenario,
                                    const std::vector<const scenario::Column*>& columns,
                                    controller::Host& host);

// Host that passes what controllers say to the watch and stops waiting when the watch stops.
[[nodiscard]] controller::Host make_host(Watch& watch);

// Starts the user's controller once, before many runs: if it cannot start, the scenario is at
// fault, not each case. `first` is the scenario of the first case.
void try_controller(const ScenarioFamily& family, Scenario first, Watch& watch);

}  // namespace bbsim::api
