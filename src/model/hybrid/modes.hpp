// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The present mode of a model, of all that switches.
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

// Of what `system` lacks, the defaults.
[[nodiscard]] Modes modes_of(const System& system);

// Takes over what rests and what moves, and which way; limits keep their own values.
void follow_friction(const Modes& modes, System& system);

}  // namespace bbsim::model
