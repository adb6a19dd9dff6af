// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Intervals by profile likelihood: how far a key can go before the best sum of squares, with all
// other keys free, has grown by what the confidence allows.
#pragma once

#include <Eigen/Core>

#include "fit/windows_fit.hpp"

namespace bbsim::fit {

struct Ends {
  double low, high;  // of the key's number; infinite where no value is refuted
};

// Finds an end as the solution of a problem of its own: the farthest value of the key at which the
// sum of squares has that growth, and is least by the other keys (Venzon and Moolgavkar, Applied
// Statistics 37, 1988). Each step solves it exactly for residuals that are linear in the keys, so
// that a few sets of derivatives are enough where a search along the profile needs one for
// each step of many minimizations.
class Profiles {
 public:
  // At the optimum `u` and its derivatives. All references must outlive this.
  Profiles(const Task& task, const WindowsFit& windows, const Eigen::VectorXd& u,
           const WindowsFit::Derivatives& derivatives);

  // Of key `k`. `growth` is the sum of squares that an end has more than the optimum has.
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
  Eigen::VectorXd lower_, upper_;  // bounds of the numbers
  Eigen::VectorXd residuals_;
  double least_;
};

}  // namespace bbsim::fit
