// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Eigenvalues of a dense matrix, compiled once: Eigen's solver takes longer to compile than all its
// callers.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

namespace bbsim::model {

// Returns them in no order; empty if the matrix or an eigenvalue is not finite, or if the iteration
// does not converge.
// Each is accurate to the rounding of the balanced matrix's largest entry.
[[nodiscard]] std::vector<std::complex<double>> eigenvalues_of(const Eigen::MatrixXd& matrix);

// The power of 2 at or below the largest entry; 1 for zeros. Squares of entries in this unit do not
// overflow.
[[nodiscard]] double unit_of(const Eigen::MatrixXd& matrix);
// The values times the unit; empty if one is beyond the range of doubles.
[[nodiscard]] std::vector<std::complex<double>> in_units(std::vector<std::complex<double>> values,
                                                         double unit);

// Returns d^-1 matrix d. The diagonal d of powers of 2 makes each row and its column similar in
// size. `scale` receives d. Parlett and Reinsch, Numerische Mathematik 13 (1969).
[[nodiscard]] Eigen::MatrixXd balanced(const Eigen::MatrixXd& matrix,
                                       Eigen::VectorXd* scale = nullptr);

}  // namespace bbsim::model
