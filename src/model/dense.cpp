#include "model/dense.hpp"

#include <Eigen/LU>
#include <unsupported/Eigen/MatrixFunctions>

namespace bbsim::model {

using Eigen::MatrixXd;

MatrixXd product(const MatrixXd& a, const MatrixXd& b) {
  return a * b;
}

MatrixXd inverse(const MatrixXd& a) {
  return a.inverse();
}

MatrixXd solve(const MatrixXd& a, const MatrixXd& b) {
  return Eigen::PartialPivLU<MatrixXd>(a).solve(b);
}

MatrixXd solve_consistent(const MatrixXd& a, const MatrixXd& b) {
  return Eigen::FullPivLU<MatrixXd>(a).solve(b);
}

std::optional<MatrixXd> solve_if_regular(const MatrixXd& a, const MatrixXd& b) {
  if (!a.allFinite()) return {};
  const Eigen::FullPivLU<MatrixXd> factors(a);
  if (!factors.isInvertible()) return {};
  MatrixXd solution = factors.solve(b);
  if (!solution.allFinite()) return {};
  return solution;
}

MatrixXd exponential(const MatrixXd& a) {
  return a.exp();
}

}  // namespace bbsim::model
