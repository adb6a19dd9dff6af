// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Scenario -> Model: what is wrong with a key is said with its place.
#pragma once

#include <vector>

#include "api/watch.hpp"
#include "controller/host.hpp"
#include "model/model.hpp"
#include "scenario/columns.hpp"

namespace bbsim::api {

// The model that these columns need, to be looked at. Throws InputError.
[[nodiscard]] model::Model assemble(const Scenario& scenario,
                                    const std::vector<const scenario::Column*>& columns,
                                    model::Form form = model::Form::reduced);

// The same, to be run: with its controller, if the scene has one of its own.
[[nodiscard]] model::Model assemble(const Scenario& scenario,
                                    const std::vector<const scenario::Column*>& columns,
                                    controller::Host& host,
                                    model::Form form = model::Form::reduced);

// A host whose programs say to the watch what they have to say, and wait no longer than it lets.
[[nodiscard]] controller::Host make_host(Watch& watch);

}  // namespace bbsim::api
