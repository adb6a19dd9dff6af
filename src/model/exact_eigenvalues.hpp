// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Eigenvalues in quad precision: those of 1e-13 1/s stay accurate beside a stiff part of 1e13 1/s.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

namespace bbsim::model {

// Returns the eigenvalues of the given doubles taken as exact, in no order. Complex ones come in
// pairs, positive imaginary part first. Empty if the matrix is not finite or the iteration does not
// converge. Takes about 0.5 us times the cube of the size.
[[nodiscard]] std::vector<std::complex<double>> exact_eigenvalues(const Eigen::MatrixXd& matrix);

// Largest number of rows that does not take too long.
inline constexpr Eigen::Index most_exact = 60;

// Bound on an eigenvalue's rounding error, relative to the matrix's largest entry.
[[nodiscard]] double exact_rounding(Eigen::Index size);

}  // namespace bbsim::model
