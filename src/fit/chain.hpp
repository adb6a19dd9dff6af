// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Windows that follow one another as one trajectory: where one ends, the next begins (multiple
// shooting; Bock, Proceedings in Applied Mathematics, 1981).
#pragma once

#include <Eigen/Core>
#include <vector>

namespace bbsim::fit {

// One window, linear about its start.
struct Link {
  Eigen::VectorXd residual;
  Eigen::MatrixXd by_start, by_key;  // derivatives of the residual
  // Where the next window goes on: how far its start is from this one's end, and the derivatives of
  // the end.
  Eigen::VectorXd gap;
  Eigen::MatrixXd end_by_start, end_by_key;
};

// A chain of windows without the starts that its joints give: residuals of all windows and changes
// of their starts follow from the change `d` of the first start and that of the keys.
struct Condensed {
  Eigen::VectorXd residual;
  Eigen::MatrixXd by_first, by_key;
  // Of each window, the change of its start that closes the gaps before it, and what d and the keys
  // add to it.
  struct Shift {
    Eigen::VectorXd closing;
    Eigen::MatrixXd by_first, by_key;
  };
  std::vector<Shift> shifts;

  // The d with the least residuals at the present keys; by each key.
  [[nodiscard]] Eigen::VectorXd best_first() const;
  [[nodiscard]] Eigen::MatrixXd best_first_by_key() const;
};

// `first`: the directions in which the first start is free, a column each. With `keys` the
// derivatives by keys are there, too.
[[nodiscard]] Condensed condense(const std::vector<const Link*>& links,
                                 const Eigen::MatrixXd& first, Eigen::Index keys);

}  // namespace bbsim::fit
