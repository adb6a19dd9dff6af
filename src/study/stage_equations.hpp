// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The stage equations of collocation for linear equations S' = J(t) S + F(t).
#pragma once

#include <Eigen/Core>
#include <vector>

namespace bbsim::study {

// Solves S_i = start + h sum_j a_ij (J_j S_j + F_j), i = 1, ..., s. `jacobians` has J_1, ..., J_s,
// n x n. `stages` holds F on entry and S on return: row j n + i is the i-th state at node j, and
// each column is one right-hand side. `matrix` has a_ij, `start` is n x columns.
//
// States that drive others without feedback are solved first: the gimbal before the ball.
void solve_stages(const std::vector<Eigen::MatrixXd>& jacobians, const Eigen::MatrixXd& matrix,
                  double h, const Eigen::MatrixXd& start, Eigen::MatrixXd& stages);

}  // namespace bbsim::study
