// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Eigenvalues of a dense matrix: in one place, since Eigen's solver takes a compiler longer
// than all that makes use of it.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

namespace bbsim::model {

// In no order. Nothing where the matrix is not finite or the iteration does not converge. Each is
// known to the rounding of the balanced matrix's largest entry.
[[nodiscard]] std::vector<std::complex<double>> eigenvalues_of(const Eigen::MatrixXd& matrix);

// d^-1 matrix d, with the diagonal d of powers of 2 that makes a row and the column of its number
// alike in size. Parlett and Reinsch, Numerische Mathematik 13 (1969).
// `scale` gets the diagonal.
[[nodiscard]] Eigen::MatrixXd balanced(const Eigen::MatrixXd& matrix,
                                       Eigen::VectorXd* scale = nullptr);

}  // namespace bbsim::model
