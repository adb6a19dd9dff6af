// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Measures error and processor time of every tool at every tolerance, for one scene.
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
  double seconds = 0;  // processor time, the least of all runs
  int runs = 0;
};

// Points of runs that reached their end. The tools take turns, so that other load on the machine
// affects all of them alike. Each point is measured until its least time settles or `budget`
// seconds are used up. The least time is the best estimate, because other load can only increase
// it.
[[nodiscard]] std::vector<Point> measure(const Scene& scene, const std::vector<double>& rtols,
                                         double budget);

}  // namespace bbsim::bench
