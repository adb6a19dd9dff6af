// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The exact Jacobian of a system, by forward-mode automatic differentiation.
#pragma once

#include <Eigen/Core>

#include "simd/gradient.hpp"

namespace bbsim::model {

template <class System>
using JacobianOf = Eigen::Matrix<double, System::size, System::size>;

// J(i, j) = d f_i / d z_j at z for given inputs. Allocates nothing.
template <class System, class Inputs>
[[nodiscard]] JacobianOf<System> jacobian_under(const System& system, const Inputs& inputs,
                                                const double* z) {
  constexpr int n = System::size;
  simd::WithGradient<n> state[n], rate[n];
  for (int i = 0; i < n; ++i) state[i] = simd::WithGradient<n>::variable(z[i], i);
  system.derivative_of(inputs, state, rate);
  JacobianOf<System> matrix;
  for (int i = 0; i < n; ++i) matrix.row(i) = rate[i].gradient.transpose();
  return matrix;
}

// The Jacobian at (t, z).
template <class System>
[[nodiscard]] JacobianOf<System> jacobian(const System& system, double t, const double* z) {
  return jacobian_under(system, system.inputs(t), z);
}

}  // namespace bbsim::model
