// The exact Jacobian of a system, by forward-mode automatic differentiation.
#pragma once

#include <Eigen/Core>
#include <unsupported/Eigen/AutoDiff>

namespace bbsim::model {

template <class System>
using JacobianOf = Eigen::Matrix<double, System::size, System::size>;

// J(i, j) = d f_i / d z_j at (t, z). No allocation.
template <class System>
[[nodiscard]] JacobianOf<System> jacobian(const System& system, double t, const double* z) {
  constexpr int n = System::size;
  using Gradient = Eigen::Matrix<double, n, 1>;
  using Dual = Eigen::AutoDiffScalar<Gradient>;
  Dual state[n], rate[n];
  for (int i = 0; i < n; ++i) state[i] = Dual(z[i], n, i);
  for (int i = 0; i < n; ++i) rate[i].derivatives().setZero();
  system.derivative(t, state, rate);
  JacobianOf<System> matrix;
  for (int i = 0; i < n; ++i) matrix.row(i) = rate[i].derivatives().transpose();
  return matrix;
}

}  // namespace bbsim::model
