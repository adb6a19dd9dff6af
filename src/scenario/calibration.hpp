// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Makes a curve of a servo's calibration, as it was measured, one that rises or falls throughout.
#pragma once

#include <string>

#include "scenario/scenario.hpp"

namespace bbsim::scenario {

struct Calibration {
  std::string done;      // "2 repeated angles averaged, ..."; empty if the rows are as they were
  bool changes = false;  // the curve itself, not just its rows' order and repetitions
};

// Sorts the rows by the servo's angle and averages those that repeat it. Flat ends are cut, and
// rows that noise puts in the wrong order get their mean: the nearest curve in least squares that
// does not turn back (isotonic regression by pooling adjacent violators; Ayer et al., Ann. Math.
// Statist. 26, 1955), with one row for each level. What turns back by more than noise stays, and so
// does a curve that needs nothing.
Calibration calibrate(CurveLinkage& curve);

}  // namespace bbsim::scenario
