// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A linear system with named signals, and its zeros.
#pragma once

#include <Eigen/Core>
#include <complex>
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

// Returns the finite s at which [A - sI, B; C, D] loses rank, by falling real part; with a period,
// the z. A is n x n, B n x m, C m x n, D m x m. Empty for other shapes, which have no zeros in
// general, and if a number is not finite. Units and time scales do not matter: an entry counts as 0
// by the terms of its own sum, not by the largest entry.
//
// Method: the steps of Emami-Naeini and Van Dooren, Automatica 18 (1982), by elimination, reduce
// the system to one whose D is invertible. A generalized eigenvalue problem would have the infinite
// zeros too, which rounding turns into large finite ones.
[[nodiscard]] std::vector<std::complex<double>> transmission_zeros(const Eigen::MatrixXd& a,
                                                                   const Eigen::MatrixXd& b,
                                                                   const Eigen::MatrixXd& c,
                                                                   const Eigen::MatrixXd& d);

}  // namespace bbsim::model
