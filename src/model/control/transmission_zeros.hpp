// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Transmission zeros of a linear system.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

namespace bbsim::model {

// Where [A - sI, B; C, D] loses rank: the finite ones alone, by falling real part. For as many
// inputs as outputs; of other systems there are none in general, and none are returned. Units and
// time scales do not matter: what is 0 is told by the terms of its own sum, and not by the largest
// entry.
//
// Method: the steps of Emami-Naeini and Van Dooren, Automatica 18 (1982), by elimination: the
// system is reduced to one whose D is invertible. A generalised eigenvalue problem has the infinite
// zeros too, which rounding makes large finite ones.
[[nodiscard]] std::vector<std::complex<double>> transmission_zeros(const Eigen::MatrixXd& a,
                                                                   const Eigen::MatrixXd& b,
                                                                   const Eigen::MatrixXd& c,
                                                                   const Eigen::MatrixXd& d);

}  // namespace bbsim::model
