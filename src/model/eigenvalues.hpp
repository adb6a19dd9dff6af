// Eigenvalues of a dense matrix: in one place, since Eigen's solver takes a compiler longer than
// all that makes use of it.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

namespace bbsim::model {

// In no order. Nothing where the matrix is not finite or the iteration does not converge.
[[nodiscard]] std::vector<std::complex<double>> eigenvalues_of(const Eigen::MatrixXd& matrix);

}  // namespace bbsim::model
