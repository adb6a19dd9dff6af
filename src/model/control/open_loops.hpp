// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Open loops over the frequency, for a Bode plot.
#pragma once

#include <vector>

#include "model/control/linearize.hpp"

namespace bbsim::model {

struct OpenLoops {
  // Rising, as dense as a picture needs, from a thirtieth of the slowest pole to thirty times the
  // fastest, or to half the sampling rate; rad/s.
  std::vector<double> frequencies;
  struct Curve {
    std::vector<double> gain;
    std::vector<double> phase;  // rad, without jumps; the first is between -7/4 pi and pi/4
  };
  std::vector<Curve> curves;  // of each loop of `margins`
};

// The loops of a linearization's margins: each broken at its command, with the other one closed.
// Empty if it has none.
[[nodiscard]] OpenLoops open_loops(const Linearization& linearization);

}  // namespace bbsim::model
