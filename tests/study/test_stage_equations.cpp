// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The stage equations of derivatives by keys, solved in blocks and as a whole.

#include <Eigen/LU>
#include <random>
#include <vector>

#include "catch.hpp"
#include "study/stage_choice.hpp"
#include "study/stage_equations.hpp"

using namespace bbsim;

TEST_CASE("stage equations in blocks have the solution of the whole system", "[sensitivity]") {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> number(-1, 1);
  constexpr Eigen::Index n = 7, s = 4, columns = 3;
  constexpr double h = 0.3;
  // Numbers 4 and 6 drive each other, 5 is alone, and all three drive the others.
  const auto depends = [](Eigen::Index i, Eigen::Index k) {
    if (i == 5) return k == 5;
    if (i == 4 || i == 6) return k == 4 || k == 6;
    return true;
  };
  const auto fill = [&](Eigen::MatrixXd& matrix) {
    for (double& one : matrix.reshaped()) one = number(random);
  };
  for (const bool sparse : {true, false}) {
    std::vector<Eigen::MatrixXd> jacobians;
    for (int j = 0; j < s; ++j) {
      fill(jacobians.emplace_back(n, n));
      for (Eigen::Index i = 0; i < n; ++i) {
        for (Eigen::Index k = 0; k < n; ++k) {
          if (sparse && !depends(i, k)) jacobians.back()(i, k) = 0;
        }
      }
    }
    Eigen::MatrixXd matrix(s, s), start(n, columns), stages(n * s, columns);
    fill(matrix);
    fill(start);
    fill(stages);
    Eigen::MatrixXd left = Eigen::MatrixXd::Identity(n * s, n * s);
    Eigen::MatrixXd right = start.replicate(s, 1);
    for (Eigen::Index i = 0; i < s; ++i) {
      for (Eigen::Index j = 0; j < s; ++j) {
        left.block(i * n, j * n, n, n) -= h * matrix(i, j) * jacobians[static_cast<std::size_t>(j)];
        right.middleRows(i * n, n) += h * matrix(i, j) * stages.middleRows(j * n, n);
      }
    }
    study::solve_stages(jacobians, matrix, h, start, stages);
    const Eigen::MatrixXd expected = left.fullPivLu().solve(right);
    const double condition = left.fullPivLu().inverse().norm() * left.norm();
    CHECK((stages - expected).norm() < 1e-15 * condition * expected.norm());
  }
}

TEST_CASE("step lengths that failed get more stages", "[sensitivity]") {
  study::StageChoice choice;
  CHECK(choice.of(1) == 0);
  choice.fail(0, 1);
  choice.fail(1, 1);
  CHECK(choice.of(1) == 2);
  CHECK(choice.of(0.5) == 0);
  for (std::size_t i = 0; i < study::StageChoice::last; ++i) choice.fail(i, 1e-3);
  CHECK(choice.of(1) == study::StageChoice::last);
  // In the long run fewer steps are repeated.
  int steps = 0;
  while (choice.of(1e-3) == study::StageChoice::last && steps < 1000) {
    choice.pass(study::StageChoice::last);
    ++steps;
  }
  CHECK(steps > 20);
  CHECK(steps < 100);
}
