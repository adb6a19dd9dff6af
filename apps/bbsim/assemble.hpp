// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Scenario -> Model, for a command: what is wrong with a key is said with its place.
#pragma once

#include <atomic>
#include <string_view>
#include <vector>

#include "controller/host.hpp"
#include "model/model.hpp"
#include "scenario/columns.hpp"

namespace bbsim::app {

// The model that these columns need, to be looked at. Throws InputError.
[[nodiscard]] model::Model assemble(const Scenario& scenario,
                                    const std::vector<const scenario::Column*>& columns);

// The same, to be run: with its controller, if the scene has one of its own.
[[nodiscard]] model::Model assemble(const Scenario& scenario,
                                    const std::vector<const scenario::Column*>& columns,
                                    controller::Host& host);

// Gives the scene's model its controller, as Host::attach() does. Throws InputError.
void attach(controller::Host& host, const Scenario& scenario, model::Model& model);

// Says a line of a controller's standard error.
void say_of_controller(std::string_view line);

// A host whose programs say on the terminal what they have to say; `stop` may be null.
[[nodiscard]] controller::Host make_host(const std::atomic<bool>* stop);

}  // namespace bbsim::app
