// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Commands from outside in place of a scenario's law: of a caller that steps a run, or of a page.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "base/pair.hpp"
#include "model/control/external_controller.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::api {

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
