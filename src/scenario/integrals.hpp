// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What a run integrates only if a column or a measure asks for it.
#pragma once

#include <vector>

namespace bbsim::scenario {

struct Column;

struct Integrals {
  bool gamma;        // the angle gamma
  bool work = true;  // the motors' work, in a scene with couples, linkages or torques

  // NOLINTNEXTLINE(google-explicit-constructor): with the work
  Integrals(bool with_gamma) : gamma(with_gamma) {}
};

[[nodiscard]] Integrals integrals_for(const std::vector<const Column*>& columns);

}  // namespace bbsim::scenario
