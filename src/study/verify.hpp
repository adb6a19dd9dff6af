// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Checks this build against known answers.
#pragma once

#include <string>
#include <vector>

#include "scenario/scenario.hpp"
#include "solve/outcome.hpp"

namespace bbsim::study {

// One comparison of a run with a known answer.
struct Check {
  std::string name;
  double error = 0, bound = 0;                                 // m
  [[nodiscard]] bool holds() const { return error <= bound; }  // false for NaN
};

struct Verification {
  std::vector<Check> checks;
  bool interrupted = false;  // if so, checks has only those finished before
  [[nodiscard]] bool holds() const;
};

// Checks closed forms, the paper's Fig. 2, and other quad-precision references. Needs no files: all
// scenes are part of the program.
[[nodiscard]] Verification verify(const solve::Watch& watch = {});

// The scenes of the paper's Fig. 2, with overrides.
[[nodiscard]] std::vector<Scenario> paper_scenes(const std::vector<std::string>& overrides);

}  // namespace bbsim::study
