// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Turns a measured calibration of a servo into a curve that rises or falls throughout.
#pragma once

#include <string>

#include "scenario/scenario.hpp"

namespace bbsim::scenario {

struct Calibration {
  std::string done;      // "2 repeated angles averaged, ..."; empty if nothing changed
  bool changes = false;  // of the curve itself, not only the order and repetition of rows
};

// Sorts the rows by the servo's angle and averages rows with the same angle. Cuts flat ends, and
// gives rows that noise puts in the wrong order their mean: the nearest monotonic curve in least
// squares (isotonic regression by pooling adjacent violators; Ayer et al., Ann. Math. Statist. 26,
// 1955), with one row for each level. Only sorts and averages a curve that turns back by more than
// noise.
Calibration calibrate(CurveLinkage& curve);

}  // namespace bbsim::scenario
