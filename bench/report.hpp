// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Texts and files of the benchmark.
#pragma once

#include <string>
#include <vector>

#include "measure.hpp"

namespace bbsim::bench {

struct Measured {
  std::string scene;
  std::vector<Point> points;
};

// Times at equal error and their ratios, beside their targets. `kernels` is the instruction set
// that ran.
[[nodiscard]] std::string ratio_table(const std::vector<Measured>& scenes,
                                      const std::string& kernels);

// scene,tool,rtol,atol,error_m,time_us,runs
[[nodiscard]] std::string points_csv(const std::vector<Measured>& scenes);

}  // namespace bbsim::bench
