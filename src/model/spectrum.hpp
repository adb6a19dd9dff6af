// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Eigenvalues of the exact Jacobian: how a scene behaves near a state.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "model/model.hpp"

namespace bbsim::model {

using Eigenvalues = std::vector<std::complex<double>>;  // 1/s, by falling real part

// The eigenvalues of the whole right-hand side, linearized at (t, z).
[[nodiscard]] Eigenvalues eigenvalues(const Model& model, double t, const double* z);

// Poles about home (all angles, positions and rates zero), without dry parts and without the spin:
// no controller acts on the spin, and it adds a pole at exactly zero.
//
// Poles of the closed loop, 1/s; for a gimbal moved by given torques, of the plant. Empty for a
// given motion and for a sampled loop.
[[nodiscard]] Eigenvalues closed_loop_poles(const Model& model);
// Poles of the plant under a constant command, 1/s; for three servos without their heave.
[[nodiscard]] Eigenvalues plant_poles(const Model& model);
// Poles of a sampled loop, by falling size: eigenvalues of the map of a cycle (sampled_cycle.hpp)
// on the plant, the signals in the delays, and the controller's memory. Empty if the gains
// overflow, or if bbsim knows no law that feeds back.
[[nodiscard]] Eigenvalues sampled_poles(const Model& model);

// Eigenvalues of a matrix, by falling real part; empty if it is not finite. A real part is 0 if
// rounding of the matrix's entries could change its sign.
[[nodiscard]] Eigenvalues sorted_eigenvalues(const Eigen::MatrixXd& matrix);

// Eigenvalues of a map from period to period, by falling size. One that rounding of the entries
// could move across the unit circle is put on it, to the last digit of a double.
[[nodiscard]] Eigenvalues poles_of_period(const Eigen::MatrixXd& map);

// Whether all poles lie inside the border of stability; a pole on it, up to rounding, does not.
[[nodiscard]] bool stable(const Eigenvalues& poles);
[[nodiscard]] bool stable_by_period(const Eigenvalues& poles);
// Number of poles beyond the border.
[[nodiscard]] int growing(const Eigenvalues& poles);
[[nodiscard]] int growing_by_period(const Eigenvalues& poles);

}  // namespace bbsim::model
