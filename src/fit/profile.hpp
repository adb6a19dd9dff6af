// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Intervals by profile likelihood: how far a key can move before the best sum of squares, with all
// other keys free, grows by the amount that the confidence level allows.
#pragma once

#include <Eigen/Core>

#include "fit/windows_fit.hpp"

namespace bbsim::fit {

struct Ends {
  double low, high;  // of the key's number u; infinite if no value is refuted
};

// Finds an end as the solution of its own problem: the farthest value of the key at which the sum
// of squares has that growth and is least in the other keys (Venzon and Moolgavkar, Applied
// Statistics 37, 1988). Each step is exact for residuals that are linear in the keys. A few sets of
// derivatives are therefore enough, whereas a search along the profile needs one per step of many
// minimizations.
class Profiles {
 public:
  // `u` is the optimum, with its derivatives. All references must outlive this.
  Profiles(const Task& task, const WindowsFit& windows, const Eigen::VectorXd& u,
           const WindowsFit::Derivatives& derivatives);

  // Interval of key `k`. `growth`: sum of squares at an end minus that at the optimum.
  [[nodiscard]] Ends ends(Eigen::Index k, double growth) const;

 private:
  struct Point;
  struct Step;
  [[nodiscard]] double distance(Eigen::Index k, double growth, double sign) const;
  [[nodiscard]] Step step_from(const Point& from, Eigen::Index k, double sign, double target,
                               double most) const;

  const Task& task_;
  const WindowsFit& windows_;
  const Eigen::VectorXd& u_;
  const Eigen::MatrixXd& jacobian_;
  Eigen::VectorXd lower_, upper_;  // bounds of the numbers u
  Eigen::VectorXd residuals_;
  double least_;
};

}  // namespace bbsim::fit
