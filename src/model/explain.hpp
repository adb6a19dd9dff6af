// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What is modelled of a scene and what is not, and why: for `bbsim check` and the summary.
#pragma once

#include <string>
#include <vector>

#include "model/model.hpp"

namespace bbsim::model {

// A part of the physics that the scene has, or does without, and why.
struct Note {
  std::string part, reason;
};

// `model` is what assemble() made of the scene.
[[nodiscard]] std::vector<Note> explain(const Scenario& scene, const Model& model);

}  // namespace bbsim::model
