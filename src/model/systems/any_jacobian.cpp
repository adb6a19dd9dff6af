// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/systems/any_jacobian.hpp"

#include <type_traits>
#include <variant>

#include "model/systems/jacobian.hpp"

namespace bbsim::model {

namespace {

template <class System, class Inputs>
void put_jacobian(const System& system, const Inputs& inputs, const double* z, double* matrix) {
  Eigen::Map<JacobianOf<System>> target(matrix);  // column-major
  target = jacobian_under(system, inputs, z);
}

}  // namespace

void jacobian(const System& system, double t, const double* z, double* matrix) {
  std::visit([&](const auto& any) { put_jacobian(any, any.inputs(t), z, matrix); }, system);
}

void jacobian_at_home(const System& system, double* matrix) {
  std::visit(
      [&](const auto& any) {
        const double home[std::decay_t<decltype(any)>::size] = {};
        put_jacobian(any, decltype(any.inputs(0.0)){}, home, matrix);
      },
      system);
}

}  // namespace bbsim::model
