// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Chooses the integrator for a scene.
#pragma once

#include <string>
#include <string_view>

#include "model/model.hpp"
#include "solve/outcome.hpp"

namespace bbsim::solve {

// Name of the method in scenarios, such as "bdf". Empty if it has none.
[[nodiscard]] std::string_view method_name(Method method);

// Returns radau for automatic, and any other method unchanged.
//
// Radau is the cheapest method at every error, by factors of 2 to 30, over all scenes (smooth and
// stiff) and all tolerances (docs/explanation/accuracy.md). Neither stability nor order limits its
// steps. Only its number of stages depends on the tolerance, and radau chooses that itself.
[[nodiscard]] Method choose_method(Method asked);

// Decay rate of the fastest mode times `end` (s): the number of times that the mode decays by a
// factor of e over the scene. Above about 100, stability limits the steps of an explicit method.
[[nodiscard]] double decays_over_scene(const model::Model& model, double end);

}  // namespace bbsim::solve
