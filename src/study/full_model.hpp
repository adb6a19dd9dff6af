// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What the full model buys: a scene with simpler equations for the ball, against equation (27).
#pragma once

#include <string>
#include <vector>

#include "scenario/scenario.hpp"
#include "solve/outcome.hpp"

namespace bbsim::study {

struct SimplerModel {
  std::string name;
  std::string equation;
  double dx = 0, dy = 0;        // largest |difference| from the full model over the output times, m
  double at_dx = 0, at_dy = 0;  // when, s
  double reached = 0;           // the comparison's end: the scene's, or where a model failed, s
};

struct FullModelStudy {
  std::vector<SimplerModel> simpler;
  double reached = 0;  // of the full model, s
  bool interrupted = false;
};

// Throws InputError, with what is allowed, for a scene that compare_simpler() does not take.
void require_comparable(const Scenario& scenario);

// Runs the scene with equation (27) and with two simpler equations in its place; a controller acts
// on whichever ball is there. Tolerances of 1e-9 and 1e-11, whatever the scene's own.
[[nodiscard]] FullModelStudy compare_simpler(const Scenario& scenario,
                                             const solve::Watch& watch = {});

}  // namespace bbsim::study
