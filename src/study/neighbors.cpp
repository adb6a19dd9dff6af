// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "study/neighbors.hpp"

namespace bbsim::study {

Eigen::VectorXd slope_of_extras(const Neighbors& neighbors, double t, const Eigen::VectorXd& z,
                                const Eigen::VectorXd& slope) {
  const auto count = static_cast<Eigen::Index>(neighbors.models.front().extras());
  return neighbors.slope([&](std::size_t i) -> Eigen::VectorXd {
    const Eigen::VectorXd moved = z + Neighbors::offsets[i] * neighbors.key.step * slope;
    Eigen::VectorXd its = Eigen::VectorXd::Zero(count);
    std::visit(
        [&](const auto& any) {
          using Any = std::decay_t<decltype(any)>;
          if constexpr (model::is_rig<Any> || model::is_coupled<Any>) {
            any.extras(t, moved.data()).pack(its.data());
          }
        },
        neighbors.models[i].system);
    return its;
  });
}

}  // namespace bbsim::study
