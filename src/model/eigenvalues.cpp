#include "model/eigenvalues.hpp"

#include <Eigen/Eigenvalues>

namespace bbsim::model {

std::vector<std::complex<double>> eigenvalues_of(const Eigen::MatrixXd& matrix) {
  if (!matrix.allFinite()) return {};
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(matrix, false);
  if (solver.info() != Eigen::Success) return {};
  return {solver.eigenvalues().begin(), solver.eigenvalues().end()};
}

}  // namespace bbsim::model
