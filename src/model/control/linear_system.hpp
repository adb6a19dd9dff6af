// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A linear system with named signals.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace bbsim::model {

// z' = A z + B u; with a period, z one period later replaces z'.
struct LinearPlant {
  Eigen::MatrixXd a, b;
};

struct LinearSignal {
  std::string name, unit;
};

// dz = A z + B u, y = C z + D u, where dz is z', or, with a period, z one period later. All are
// deviations from the point of linearization.
struct LinearSystem {
  std::vector<LinearSignal> states, inputs, outputs;
  Eigen::MatrixXd a, b, c, d;
  std::optional<double> period;  // s
};

}  // namespace bbsim::model
