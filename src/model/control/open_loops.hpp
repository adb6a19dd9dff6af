// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Open loops over the frequency, for a Bode plot.
#pragma once

#include <vector>

#include "model/control/linearize.hpp"

namespace bbsim::model {

// Rising frequencies at which to look at the loops of a linearization's margins, from a thirtieth
// of the slowest pole to thirty times the fastest, or to half the sampling rate; rad/s. Empty
// without loops.
[[nodiscard]] std::vector<double> open_loop_frequencies(const Linearization& linearization);

struct OpenLoops {
  std::vector<double> frequencies;  // some of those, as many as a picture needs
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
