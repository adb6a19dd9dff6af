// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Transmission zeros of a linear system.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

namespace bbsim::model {

// The finite s at which [A - sI, B; C, D] loses rank, by falling real part; of a system from sample
// to sample, the z. A is n x n, B n x m, C m x n, D m x m. Other systems have none in general, and
// none are returned; nor of matrices that are not finite. Units and time scales do not matter:
// whether an entry is 0 is told by the terms of its own sum, and not by the largest entry.
//
// Method: the steps of Emami-Naeini and Van Dooren, Automatica 18 (1982), by elimination: the
// system is reduced to one whose D is invertible. A generalized eigenvalue problem has the infinite
// zeros too, which rounding makes large finite ones.
[[nodiscard]] std::vector<std::complex<double>> transmission_zeros(const Eigen::MatrixXd& a,
                                                                   const Eigen::MatrixXd& b,
                                                                   const Eigen::MatrixXd& c,
                                                                   const Eigen::MatrixXd& d);

}  // namespace bbsim::model
