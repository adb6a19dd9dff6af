// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A linear system with the names of what it is about.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace bbsim::model {

// z' = A z + B u; or, with a period, z a period later.
struct LinearPlant {
  Eigen::MatrixXd a, b;
};

struct LinearSignal {
  std::string name, unit;
};

// dz = A z + B u, y = C z + D u, where dz is z', or, with a period, z a period later. All are
// deviations from the point about which the system is linear.
struct LinearSystem {
  std::vector<LinearSignal> states, inputs, outputs;
  Eigen::MatrixXd a, b, c, d;
  std::optional<double> period;  // s
};

}  // namespace bbsim::model
