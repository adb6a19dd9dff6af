// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Eigenvalues in quad precision: a stiff part of 1e13 1/s leaves those of 1e-13 1/s right.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

namespace bbsim::model {

// Those of the matrix of these very doubles, in no order: complex ones in pairs, the one with a
// positive imaginary part first. Nothing where the matrix is not finite or the iteration does not
// converge. Takes some 0.5 us times the cube of the size.
[[nodiscard]] std::vector<std::complex<double>> exact_eigenvalues(const Eigen::MatrixXd& matrix);

// A matrix of more rows takes too long.
inline constexpr Eigen::Index most_exact = 60;

// How far rounding moves any of these at most, relative to the matrix's largest entry.
[[nodiscard]] double exact_rounding(Eigen::Index size);

}  // namespace bbsim::model
