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
// Returns d^-1 matrix d. The diagonal d of powers of 2 makes each row and its column similar in
// size. `scale` receives d. Parlett and Reinsch, Numerische Mathematik 13 (1969).
[[nodiscard]] Eigen::MatrixXd balanced(const Eigen::MatrixXd& matrix,
                                       Eigen::VectorXd* scale = nullptr);

// In quad precision: eigenvalues of 1e-13 1/s stay accurate beside a stiff part of 1e13 1/s.
// Returns the eigenvalues of the given doubles taken as exact, in no order. Complex ones come in
// pairs, positive imaginary part first. Empty if the matrix is not finite or the iteration does not
// converge. Takes about 0.5 us times the cube of the size.
[[nodiscard]] std::vector<std::complex<double>> exact_eigenvalues(const Eigen::MatrixXd& matrix);

// Largest number of rows that does not take too long.
inline constexpr Eigen::Index most_exact = 60;

// Bound on an eigenvalue's rounding error, relative to the matrix's largest entry.
[[nodiscard]] double exact_rounding(Eigen::Index size);

}  // namespace bbsim::model
