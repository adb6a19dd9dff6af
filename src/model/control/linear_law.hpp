// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The control law near a point, by differentiating it.
#pragma once

#include <Eigen/Core>
#include <array>

#include "model/control/law.hpp"

namespace bbsim::model {

// u = of_feedback (position, velocity, angles, rates, integrals) + of_reference (values, rates,
// accelerations), two of each; as deviations from the point.
struct LinearLaw {
  Eigen::Matrix<double, 2, 10> of_feedback;
  Eigen::Matrix<double, 2, 6> of_reference;
};

// At what is fed back and the reference there, without limits. Not for feedback linearisation,
// which asks for the plant's equations; a held command depends on nothing.
[[nodiscard]] LinearLaw linear_law(const ControlLaw& law, const Feedback<double>& at,
                                   const std::array<Jet<double>, 2>& reference);

}  // namespace bbsim::model
