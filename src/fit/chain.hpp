// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Multiple shooting: consecutive windows form one trajectory, each starting where the last ends
// (Bock, Proceedings in Applied Mathematics, 1981).
#pragma once

#include <Eigen/Core>
#include <vector>

namespace bbsim::fit {

// One window, linearized about its start.
struct Link {
  Eigen::VectorXd residual;
  Eigen::MatrixXd by_start, by_key;  // derivatives of the residual
  // Joint to the next window: this end minus the next start, and derivatives of the end.
  Eigen::VectorXd gap;
  Eigen::MatrixXd end_by_start, end_by_key;
};

// A chain of windows with the interior starts eliminated: all residuals and changes of starts
// follow from the change `d` of the first start and that of the keys.
struct Condensed {
  Eigen::VectorXd residual;
  Eigen::MatrixXd by_first, by_key;
  // Change of one window's start that closes the gaps before it, and its derivatives by d and keys.
  struct Shift {
    Eigen::VectorXd closing;
    Eigen::MatrixXd by_first, by_key;
  };
  std::vector<Shift> shifts;

  // The d with the least residuals at the present keys, and its derivatives by the keys.
  [[nodiscard]] Eigen::VectorXd best_first() const;
  [[nodiscard]] Eigen::MatrixXd best_first_by_key() const;
};

// `first` has a column for each free direction of the first start. If `keys` is 0, derivatives by
// keys are left out.
[[nodiscard]] Condensed condense(const std::vector<const Link*>& links,
                                 const Eigen::MatrixXd& first, Eigen::Index keys);

}  // namespace bbsim::fit
