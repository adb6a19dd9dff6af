// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Eigenvalues of the exact Jacobian: how a scene behaves near a state.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <optional>
#include <vector>

#include "model/control/linear_system.hpp"
#include "model/model.hpp"

namespace bbsim::model {

using Eigenvalues = std::vector<std::complex<double>>;  // 1/s, by falling real part

// The eigenvalues of the whole right-hand side, linearized at (t, z).
[[nodiscard]] Eigenvalues eigenvalues(const Model& model, double t, const double* z);

// Poles about home (all angles, positions and rates zero), without dry parts, without the spin,
// because no controller acts on it and it adds a pole at exactly zero, and without the idle axis.
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

// A loop's matrix, from period to period or of the rates, and how the law's commands depend on its
// states.
struct LinearLoop {
  std::vector<LinearSignal> states;
  Eigen::MatrixXd a, law;
};
// Whether the law leaves an axis alone, and neither it nor the other states act on each other.
[[nodiscard]] bool stands_apart(const LinearLoop& loop, int axis);
// The axis (0: x and phi; 1: y and theta) that no command moves and that no reference leads, while
// the other one is moved, and neither acts on the other. The ball stands anywhere on it: it has
// poles at the stability limit, which say nothing about the loop.
[[nodiscard]] std::optional<int> idle_axis(const Model& model, const LinearLoop& loop);
[[nodiscard]] std::optional<int> idle_axis(const Model& model);
// Indices of all states but those of an axis.
[[nodiscard]] std::vector<int> states_without(const std::vector<LinearSignal>& states,
                                              std::optional<int> axis);

// Eigenvalues of a matrix, by falling real part; empty if it is not finite. A real part is 0 if
// rounding of the matrix's entries could change its sign.
[[nodiscard]] Eigenvalues sorted_eigenvalues(const Eigen::MatrixXd& matrix);

// Eigenvalues of a map from period to period, by falling size. One that rounding of the entries
// could move across the unit circle is put on it, to the last digit of a double.
[[nodiscard]] Eigenvalues poles_of_period(const Eigen::MatrixXd& map);

// Whether all poles lie inside the border of stability; a pole on it, up to rounding, does not.
// `by_period`: of a map from period to period.
[[nodiscard]] bool stable(const Eigenvalues& poles, bool by_period = false);
// Number of poles beyond the border.
[[nodiscard]] int growing(const Eigenvalues& poles, bool by_period = false);

}  // namespace bbsim::model
