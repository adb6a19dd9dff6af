// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The integrators to compare, all with the same interface.
#pragma once

#include <vector>

#include "scene.hpp"
#include "solve/outcome.hpp"

namespace bbsim::bench {

struct Tool {
  const char* name;
  // Integrates the scene over its whole time and fills all rows. Returns false if it gives up.
  bool (*run)(const Scene& scene, solve::Tolerances tolerances, Rows& rows);
};

// bbsim's integrator comes first.
[[nodiscard]] const std::vector<Tool>& all_tools();

}  // namespace bbsim::bench
