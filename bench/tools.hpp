// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The integrators that are compared, each behind the same call.
#pragma once

#include <vector>

#include "scene.hpp"
#include "solve/outcome.hpp"

namespace bbsim::bench {

struct Tool {
  const char* name;
  // Integrates the scene from its start to its end; all rows, or false if it gave up.
  bool (*run)(const Scene& scene, solve::Tolerances tolerances, Rows& rows);
};

// bbsim's own first.
[[nodiscard]] const std::vector<Tool>& all_tools();

}  // namespace bbsim::bench
