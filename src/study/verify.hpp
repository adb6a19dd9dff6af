// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Whether this build computes what it should: checks with known answers.
#pragma once

#include <string>
#include <vector>

#include "solve/outcome.hpp"

namespace bbsim::study {

// One comparison of a run with what is known of it. The bound is derived from the tolerance of
// the run; verify.cpp says how.
struct Check {
  std::string name;
  double error = 0;
  double bound = 0;
  std::string unit;
  [[nodiscard]] bool holds() const { return error <= bound; }  // false for NaN
};

struct Verification {
  std::vector<Check> checks;
  bool interrupted = false;  // checks are those finished before
  [[nodiscard]] bool holds() const;
};

// Closed forms, symmetries, energy, quad-precision references and method against method. Needs no
// files: all scenes are part of the program. Takes about a second.
[[nodiscard]] Verification verify(const solve::Watch& watch = {});

}  // namespace bbsim::study
