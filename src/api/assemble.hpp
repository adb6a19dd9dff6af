// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Builds the model of a scenario; errors about a key name its place. Commands from outside may
// replace its law: those of a caller that steps a run, or of a page.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "api/watch.hpp"
#include "base/error.hpp"
#include "base/pair.hpp"
#include "controller/host.hpp"
#include "model/control/external_controller.hpp"
#include "model/model.hpp"
#include "scenario/columns.hpp"
#include "scenario/family.hpp"
#include "scenario/reader.hpp"
#include "scenario/scenario.hpp"

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

// What a controller receives at a sample (docs/reference/controllers.md), SI.
struct Sample {
  std::size_t number = 0;
  double t = 0;
  std::optional<Pair> ball;
  Pair reference{}, reference_rate{}, reference_acceleration{};
  std::size_t commands = 2;  // number of commands; three, like the servos, under drives: legs
  std::array<double, 3> servo{}, servo_rate{};
};

[[nodiscard]] Sample copy_of(const model::ControllerSample& sample);

// Replaces the scenario's law with commands from outside. Throws InputError if its controller takes
// no samples, or drives legs.
[[nodiscard]] Scenario with_outside_commands(Scenario scenario);

// Throws InputError for a command that is not finite.
void require_finite(const Pair& command);

}  // namespace bbsim::api
