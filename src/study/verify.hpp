// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Checks this build against known answers.
#pragma once

#include <string>
#include <vector>

#include "solve/outcome.hpp"

namespace bbsim::study {

// One comparison of a run with a known result. The bound follows from the tolerance of the run
// (whole_run.cpp).
struct Check {
  std::string name;
  double error = 0;
  double bound = 0;
  std::string unit;
  [[nodiscard]] bool holds() const { return error <= bound; }  // false for NaN
};

struct Verification {
  std::vector<Check> checks;
  bool interrupted = false;  // if so, checks has only those finished before
  [[nodiscard]] bool holds() const;
};

// Checks closed forms, symmetries, energy, quad-precision references, and methods against each
// other. Needs no files: all scenes are part of the program. Takes about a second.
[[nodiscard]] Verification verify(const solve::Watch& watch = {});

}  // namespace bbsim::study
