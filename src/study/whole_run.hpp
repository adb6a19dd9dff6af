// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Runs whose rows are all compared with a closed form or with another run.
#pragma once

#include <vector>

#include "model/model.hpp"
#include "solve/integrate.hpp"

namespace bbsim::study {

// A run in the paper's symbols, with its allowed error.
struct WholeRun {
  std::vector<model::Sample> samples;
  double allowance = 0;  // for the states that the run reached, m
  double size = 0;       // largest |x|, |y|, |x'|, |y'|, |u|, in m and m/s
  bool done = false;     // whether it reached the end of the scene
};

[[nodiscard]] WholeRun whole_run(const Scenario& scene, const solve::Watch& watch,
                                 Method method = Method::automatic,
                                 solve::Tolerances tolerances = {1e-12, 1e-14});

}  // namespace bbsim::study
