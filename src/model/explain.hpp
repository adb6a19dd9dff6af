// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Explains what the model of a scene includes and omits, for `bbsim check` and the summary.
#pragma once

#include <string>
#include <vector>

#include "model/model.hpp"

namespace bbsim::model {

// A part of the physics, and why the model has it or not.
struct Note {
  std::string part, reason;
};

// `model` is the result of assemble() for the scene.
[[nodiscard]] std::vector<Note> explain(const Scenario& scene, const Model& model);

}  // namespace bbsim::model
