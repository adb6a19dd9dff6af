// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The present modes of all switching parts of a model.
#pragma once

#include <array>

#include "model/systems/list.hpp"

namespace bbsim::model {

struct Modes {
  RigMode rig{};
  ContactMode contact{};
  std::array<MotorMode, 2> motors{};

  bool operator==(const Modes&) const = default;
};

// Modes that `system` lacks keep their defaults.
[[nodiscard]] Modes modes_of(const System& system);

// Copies what rests and what moves, and in which direction. The modes of limits stay unchanged.
void follow_friction(const Modes& modes, System& system);

}  // namespace bbsim::model
