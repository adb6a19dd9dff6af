// Eigenvalues of a dense matrix, and the form that finding them begins with: in one place, since
// Eigen's solver takes a compiler longer than all that makes use of it.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

namespace bbsim::model {

// In no order. Nothing where the matrix is not finite or the iteration does not converge.
[[nodiscard]] std::vector<std::complex<double>> eigenvalues_of(const Eigen::MatrixXd& matrix);

// a = q h q^T, q orthogonal, h zero below the diagonal next to its own.
struct HessenbergForm {
  Eigen::MatrixXd h, q;
};
[[nodiscard]] HessenbergForm hessenberg_form(const Eigen::MatrixXd& a);

}  // namespace bbsim::model
