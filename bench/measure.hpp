// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Error and processor time of every tool at every tolerance, for one scene.
#pragma once

#include <string>
#include <vector>

#include "scene.hpp"
#include "tools.hpp"

namespace bbsim::bench {

struct Point {
  std::string tool;
  solve::Tolerances tolerances;
  double error = 0;    // max |dx|, |dy| over the output times, m
  double seconds = 0;  // of processor time, the least that any run took
  int runs = 0;
};

// The points of runs that came to their end. The tools take turns, so that whatever else the
// machine does hits all of them alike; a point is measured again and again until its least time has
// stood for a while, or has used up `budget` seconds. The least is what the work takes: all that
// others do on the machine can only add to it.
[[nodiscard]] std::vector<Point> measure(const Scene& scene, const std::vector<double>& rtols,
                                         double budget);

}  // namespace bbsim::bench
