// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Runs of which every row is compared with a closed form or with another run.
#pragma once

#include <vector>

#include "model/model.hpp"
#include "solve/integrate.hpp"

namespace bbsim::study {

// In the paper's symbols, with what it may be wrong by.
struct WholeRun {
  std::vector<model::Sample> samples;
  double allowance = 0;  // m, for the states that it reached
  double size = 0;       // largest |x|, |y|, |x'|, |y'|, |u|, in m and m/s
  bool done = false;     // it came to the scene's end
};

[[nodiscard]] WholeRun whole_run(const Scenario& scene, const solve::Watch& watch,
                                 Method method = Method::automatic,
                                 solve::Tolerances tolerances = {1e-12, 1e-14});

}  // namespace bbsim::study
