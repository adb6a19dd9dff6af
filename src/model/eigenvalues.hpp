// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Eigenvalues of a dense matrix, compiled once: Eigen's solver takes longer to compile than all its
// callers.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

namespace bbsim::model {

// Returns them in no order; empty if the matrix is not finite or the iteration does not converge.
// Each is accurate to the rounding of the balanced matrix's largest entry.
[[nodiscard]] std::vector<std::complex<double>> eigenvalues_of(const Eigen::MatrixXd& matrix);

// Returns d^-1 matrix d. The diagonal d of powers of 2 makes each row and its column similar in
// size. `scale` receives d. Parlett and Reinsch, Numerische Mathematik 13 (1969).
[[nodiscard]] Eigen::MatrixXd balanced(const Eigen::MatrixXd& matrix,
                                       Eigen::VectorXd* scale = nullptr);

}  // namespace bbsim::model
