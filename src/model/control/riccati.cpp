// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/control/riccati.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "model/control/sampled_cycle.hpp"
#include "model/dense.hpp"
#include "model/eigenvalues.hpp"

namespace bbsim::model {
namespace {

using Eigen::MatrixXd;

[[noreturn]] void throw_no_solution() {
  throw KeyError("controller.lqr",
                 "no gain stabilizes this rig with these weights; allowed: weights that observe "
                 "every mode, and gravity greater than 0");
}

// A, G, H -> H, which tends to the solution; each pass doubles the number of steps it looks ahead.
MatrixXd doubled(MatrixXd a, MatrixXd g, MatrixXd h) {
  const MatrixXd identity = MatrixXd::Identity(a.rows(), a.cols());
  for (int pass = 0; pass < 60; ++pass) {
    const MatrixXd w = identity + product(g, h), transposed = a.transpose();
    const MatrixXd wa = solve(w, a);
    const MatrixXd change = product(product(transposed, h), wa);
    g += product(product(a, solve(w, g)), transposed);
    h += change;
    a = product(a, wa);
    if (!h.allFinite() || !g.allFinite()) break;
    // By now a is the closed loop over 2^pass steps: it has to have died away.
    if (change.norm() <= 1e-15 * h.norm() && a.norm() <= 1e-6) return (h + h.transpose()) / 2;
  }
  throw_no_solution();
}

}  // namespace

RiccatiSolution solve_discrete_riccati(const MatrixXd& a, const MatrixXd& b, const MatrixXd& q,
                                       const MatrixXd& r) {
  RiccatiSolution solution;
  const MatrixXd b_transposed = b.transpose();
  solution.cost = doubled(a, product(product(b, inverse(r)), b_transposed), q);
  const MatrixXd seen = product(b_transposed, solution.cost);
  solution.gain = solve(r + product(seen, b), product(seen, a));
  return solution;
}

RiccatiSolution solve_continuous_riccati(const MatrixXd& a, const MatrixXd& b, const MatrixXd& q,
                                         const MatrixXd& r) {
  const MatrixXd identity = MatrixXd::Identity(a.rows(), a.cols());
  const MatrixXd b_transposed = b.transpose(), g = product(product(b, inverse(r)), b_transposed);
  // Any shift beyond the eigenvalues' sizes does.
  double largest = 1;
  for (const std::complex<double>& value : eigenvalues_of(a)) {
    largest = std::max(largest, std::abs(value));
  }
  const double shift = 1.5 * largest;
  const MatrixXd shifted = a - shift * identity;
  const MatrixXd transposed = shifted.transpose(), inverted = inverse(shifted);
  const MatrixXd w = inverse(transposed + product(product(q, inverted), g));
  const MatrixXd forward = inverse(shifted + product(product(g, inverse(transposed)), q));
  RiccatiSolution solution;
  solution.cost =
      doubled(identity + 2 * shift * forward, 2 * shift * product(product(inverted, g), w),
              2 * shift * product(product(w, q), inverted));
  solution.gain = product(product(inverse(r), b_transposed), solution.cost);
  return solution;
}

Eigen::Matrix<double, 2, 8> lqr_gain(const LinearPlant& plant, const LqrWeights& weights,
                                     double period) {
  Eigen::VectorXd diagonal(8);
  diagonal << weights.position, weights.position, weights.velocity, weights.velocity, weights.angle,
      weights.angle, weights.rate, weights.rate;
  const MatrixXd q = diagonal.asDiagonal();
  const MatrixXd r = weights.command * MatrixXd::Identity(2, 2);
  if (period > 0) {
    const LinearPlant step = zero_order_hold(plant, period);
    return solve_discrete_riccati(step.a, step.b, q, r).gain;
  }
  return solve_continuous_riccati(plant.a, plant.b, q, r).gain;
}

}  // namespace bbsim::model
