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

// Structured doubling: each pass doubles the number of steps of (A, G, H), and H tends to the
// solution. Chu, Fan, Lin and Wang (2004), algorithm SDA.
MatrixXd doubled(MatrixXd a, MatrixXd g, MatrixXd h) {
  const MatrixXd identity = MatrixXd::Identity(a.rows(), a.cols());
  for (int pass = 0; pass < 60; ++pass) {
    const MatrixXd w = identity + g * h, wa = solve(w, a);
    const MatrixXd change = transposed(a) * h * wa;
    g += a * solve(w, g) * transposed(a);
    h += change;
    a = a * wa;
    if (!h.allFinite() || !g.allFinite()) break;
    // By now a is the closed loop over 2^pass steps, which must have died away.
    if (change.norm() <= 1e-15 * h.norm() && a.norm() <= 1e-6) return (h + h.transpose()) / 2;
  }
  throw_no_solution();
}

}  // namespace

RiccatiSolution solve_discrete_riccati(const MatrixXd& a, const MatrixXd& b, const MatrixXd& q,
                                       const MatrixXd& r) {
  const MatrixXd x = doubled(a, b * inverse(r) * transposed(b), q);
  const MatrixXd bx = transposed(b) * x;
  return {x, solve(r + bx * b, bx * a)};
}

RiccatiSolution solve_continuous_riccati(const MatrixXd& a, const MatrixXd& b, const MatrixXd& q,
                                         const MatrixXd& r) {
  const MatrixXd identity = MatrixXd::Identity(a.rows(), a.cols());
  const MatrixXd g = b * inverse(r) * transposed(b);
  // Any shift larger than the eigenvalues works.
  double largest = 1;
  for (const std::complex<double>& value : eigenvalues_of(a)) {
    largest = std::max(largest, std::abs(value));
  }
  const double shift = 1.5 * largest;
  // The Cayley transform of the Hamiltonian matrix, in the form that doubling starts from: Chu, Fan
  // and Lin (2005).
  const MatrixXd shifted = a - shift * identity, at = transposed(shifted);
  const MatrixXd w = inverse(at + q * inverse(shifted) * g);
  const MatrixXd forward = inverse(shifted + g * inverse(at) * q);
  const MatrixXd x = doubled(identity + 2 * shift * forward, 2 * shift * (inverse(shifted) * g * w),
                             2 * shift * (w * q * inverse(shifted)));
  return {x, inverse(r) * transposed(b) * x};
}

Eigen::Matrix<double, 2, 8> lqr_gain(const LinearPlant& plant, const LqrWeights& weights,
                                     double period) {
  Eigen::VectorXd diagonal(8);
  diagonal << weights.position, weights.position, weights.velocity, weights.velocity, weights.angle,
      weights.angle, weights.rate, weights.rate;
  const MatrixXd q = diagonal.asDiagonal(), r = weights.command * MatrixXd::Identity(2, 2);
  if (period > 0) {
    const LinearPlant step = zero_order_hold(plant, period);
    return solve_discrete_riccati(step.a, step.b, q, r).gain;
  }
  return solve_continuous_riccati(plant.a, plant.b, q, r).gain;
}

}  // namespace bbsim::model
