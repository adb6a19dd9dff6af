// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/systems/any_jacobian.hpp"

#include <type_traits>
#include <variant>

#include "model/systems/jacobian.hpp"

namespace bbsim::model {

void jacobian(const System& system, double t, const double* z, double* matrix) {
  std::visit(
      [&](const auto& any) {
        Eigen::Map<JacobianOf<std::decay_t<decltype(any)>>> target(matrix);  // column-major
        target = jacobian(any, t, z);
      },
      system);
}

}  // namespace bbsim::model
