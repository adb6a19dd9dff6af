// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Which integrator suits a scene.
#pragma once

#include <string>
#include <string_view>

#include "model/model.hpp"
#include "solve/outcome.hpp"

namespace bbsim::solve {

// The method as the scenario names it: "bdf".
[[nodiscard]] std::string_view method_name(Method method);

// The integrator that runs when `asked` is: radau for automatic, any other as it is.
//
// The cost of each method was measured over all scenes, smooth and stiff, and over all tolerances
// (docs/explanation/accuracy.md): radau is the cheapest at every error, by factors of 2 to 30,
// since its steps are held down neither by stability nor by order. What depends on the tolerance is
// its number of stages, which it chooses itself.
[[nodiscard]] Method choose_method(Method asked);

// How often the fastest decaying mode decays over the scene, by a factor of e each time: over 100
// or so, an explicit method's steps are held down by stability. `end` in s.
[[nodiscard]] double decays_over_scene(const model::Model& model, double end);

}  // namespace bbsim::solve
