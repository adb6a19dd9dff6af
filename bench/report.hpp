// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The texts and files of the measurement.
#pragma once

#include <string>
#include <vector>

#include "measure.hpp"

namespace bbsim::bench {

struct Measured {
  std::string scene;
  std::vector<Point> points;
};

// Times at equal error and their ratios, each beside its target, if it has one. `kernels` is the
// instruction set that ran.
[[nodiscard]] std::string ratio_table(const std::vector<Measured>& scenes,
                                      const std::string& kernels);

// scene,tool,rtol,atol,error_m,time_us,runs
[[nodiscard]] std::string points_csv(const std::vector<Measured>& scenes);

}  // namespace bbsim::bench
