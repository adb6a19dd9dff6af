// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The exact Jacobian of any system, in one source file, because its instantiation for all systems
// takes longer to compile than all its callers.
#include <Eigen/Core>
#include <type_traits>
#include <variant>

#include "model/systems/list.hpp"
#include "simd/gradient.hpp"

namespace bbsim::model {
namespace {

template <class System>
using JacobianOf = Eigen::Matrix<double, System::size, System::size>;

// J(i, j) = d f_i / d z_j at (t, z). Allocates nothing.
template <class System>
[[nodiscard]] JacobianOf<System> jacobian(const System& system, double t, const double* z) {
  constexpr int n = System::size;
  simd::WithGradient<n> state[n], rate[n];
  for (int i = 0; i < n; ++i) state[i] = simd::WithGradient<n>::variable(z[i], i);
  derivative(system, t, state, rate);
  JacobianOf<System> matrix;
  for (int i = 0; i < n; ++i) matrix.row(i) = rate[i].gradient.transpose();
  return matrix;
}

}  // namespace

void jacobian(const System& system, double t, const double* z, double* matrix) {
  std::visit(
      [&](const auto& any) {
        Eigen::Map<JacobianOf<std::decay_t<decltype(any)>>> target(matrix);  // column-major
        target = jacobian(any, t, z);
      },
      system);
}

}  // namespace bbsim::model
