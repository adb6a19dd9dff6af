// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// How a scene behaves near a state: eigenvalues of the exact Jacobian.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "model/model.hpp"

namespace bbsim::model {

using Eigenvalues = std::vector<std::complex<double>>;  // 1/s, by falling real part

// The eigenvalues of the whole right-hand side, linearized at (t, z).
[[nodiscard]] Eigenvalues eigenvalues(const Model& model, double t, const double* z);

// About home (all angles, positions and rates zero), without what is dry, and without the spin,
// which no controller acts on and which adds a pole at exactly zero.
//
// The closed loop's poles, 1/s. Of a gimbal moved by given torques they are the plant's. Empty of a
// given motion, and of a sampled loop.
[[nodiscard]] Eigenvalues closed_loop_poles(const Model& model);
// The plant's under a constant command, 1/s; of three servos without their heave.
[[nodiscard]] Eigenvalues plant_poles(const Model& model);
// A sampled loop's: eigenvalues of what a cycle (sampled_cycle.hpp) does to the plant, to what is
// on its way through the delays, and to what the controller remembers. By falling size; empty if
// the gains are too large for numbers, or if the law is not for the model to know.
[[nodiscard]] Eigenvalues sampled_poles(const Model& model);

// Those of a matrix, in that order; nothing where it is not finite. A real part whose sign the
// rounding of the matrix's entries would change is 0.
[[nodiscard]] Eigenvalues sorted_eigenvalues(const Eigen::MatrixXd& matrix);

// Those of a map from period to period, by falling size. One whose size rounding of the entries
// would bring from one side of 1 to the other is on the unit circle, to the last digit of a double.
[[nodiscard]] Eigenvalues poles_of_period(const Eigen::MatrixXd& map);

// All poles are within the border of stability; on it, as far as rounding can tell, is not.
[[nodiscard]] bool stable(const Eigenvalues& poles);
[[nodiscard]] bool stable_by_period(const Eigenvalues& poles);
// How many are beyond it.
[[nodiscard]] int growing(const Eigenvalues& poles);
[[nodiscard]] int growing_by_period(const Eigenvalues& poles);

}  // namespace bbsim::model
