// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Checks this build against known answers, and compares simpler equations for the ball with
// equation (27).
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

struct SimplerModel {
  std::string name;
  std::string equation;
  double dx = 0, dy = 0;        // largest |difference| from the full model over the output times, m
  double at_dx = 0, at_dy = 0;  // times of these, s
  double reached = 0;  // end of the comparison: the scene's end, or where a model failed, s
};

struct FullModelStudy {
  std::vector<SimplerModel> simpler;
  double reached = 0;  // by the full model, s
  bool interrupted = false;
};

// Throws InputError if compare_simpler() does not support the scene. The message says what is
// allowed.
void require_comparable(const Scenario& scenario);

// Runs the scene with equation (27) and with two simpler equations in its place. A controller acts
// on the ball of its own run. Tolerances are 1e-9 and 1e-11, not the scene's. Throws as
// require_comparable() does.
[[nodiscard]] FullModelStudy compare_simpler(const Scenario& scenario,
                                             const solve::Watch& watch = {});

}  // namespace bbsim::study
