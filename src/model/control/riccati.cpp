#include "model/control/riccati.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "model/eigenvalues.hpp"

namespace bbsim::model {
namespace {

using Eigen::MatrixXd;

[[noreturn]] void throw_no_solution() {
  throw KeyError("controller.lqr",
                 "there is no gain that stabilises this rig with these weights; allowed: weights "
                 "that see all that moves, and gravity greater than 0");
}

// A, G, H -> H, which tends to the solution; each pass doubles the number of steps it looks ahead.
MatrixXd doubled(MatrixXd a, MatrixXd g, MatrixXd h) {
  const MatrixXd identity = MatrixXd::Identity(a.rows(), a.cols());
  for (int pass = 0; pass < 60; ++pass) {
    const Eigen::PartialPivLU<MatrixXd> w(identity + g * h);
    const MatrixXd wa = w.solve(a);
    const MatrixXd wg = w.solve(g);
    const MatrixXd change = a.transpose() * h * wa;
    g += a * wg * a.transpose();
    h += change;
    a = a * wa;
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
  solution.cost = doubled(a, b * r.inverse() * b.transpose(), q);
  solution.gain =
      (r + b.transpose() * solution.cost * b).ldlt().solve(b.transpose() * solution.cost * a);
  return solution;
}

RiccatiSolution solve_continuous_riccati(const MatrixXd& a, const MatrixXd& b, const MatrixXd& q,
                                         const MatrixXd& r) {
  const MatrixXd identity = MatrixXd::Identity(a.rows(), a.cols());
  const MatrixXd g = b * r.inverse() * b.transpose();
  // Any shift beyond the eigenvalues' sizes does.
  double largest = 1;
  for (const std::complex<double>& value : eigenvalues_of(a)) {
    largest = std::max(largest, std::abs(value));
  }
  const double shift = 1.5 * largest;
  const MatrixXd shifted = a - shift * identity;
  const MatrixXd inverse = shifted.inverse();
  const MatrixXd w = (shifted.transpose() + q * inverse * g).inverse();
  RiccatiSolution solution;
  solution.cost =
      doubled(identity + 2 * shift * (shifted + g * shifted.transpose().inverse() * q).inverse(),
              2 * shift * inverse * g * w, 2 * shift * w * q * inverse);
  solution.gain = r.inverse() * b.transpose() * solution.cost;
  return solution;
}

}  // namespace bbsim::model
