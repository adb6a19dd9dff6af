#include "model/eigenvalues.hpp"

#include <Eigen/Eigenvalues>

namespace bbsim::model {

std::vector<std::complex<double>> eigenvalues_of(const Eigen::MatrixXd& matrix) {
  if (!matrix.allFinite()) return {};
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(matrix, false);
  if (solver.info() != Eigen::Success) return {};
  return {solver.eigenvalues().begin(), solver.eigenvalues().end()};
}

HessenbergForm hessenberg_form(const Eigen::MatrixXd& a) {
  const Eigen::HessenbergDecomposition<Eigen::MatrixXd> form(a);
  return {form.matrixH(), form.matrixQ()};
}

}  // namespace bbsim::model
