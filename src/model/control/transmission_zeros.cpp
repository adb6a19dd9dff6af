#include "model/control/transmission_zeros.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <limits>
#include <utility>

#include "model/dense.hpp"
#include "model/eigenvalues.hpp"

namespace bbsim::model {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

struct Quadruple {
  MatrixXd a, b, c, d;
};

// Rows of an orthogonal matrix: first those that a matrix maps to nothing, then the others.
struct RowCompression {
  MatrixXd rows;
  Index rank;
};

RowCompression compress_rows(const MatrixXd& matrix, double rounding) {
  const Eigen::JacobiSVD<MatrixXd, Eigen::FullPivHouseholderQRPreconditioner> svd(
      matrix, Eigen::ComputeFullU);
  const auto& sizes = svd.singularValues();
  const Index rank = (sizes.array() > rounding).count();
  return {svd.matrixU().rowwise().reverse().transpose(), rank};
}

// Takes away what of the state no zero sees, until D has full row rank.
Quadruple reduced(Quadruple of, double rounding) {
  while (of.a.rows() > 0) {
    const Index n = of.a.rows(), m = of.b.cols(), p = of.c.rows();
    const RowCompression of_d = compress_rows(of.d, rounding);
    const Index sigma = of_d.rank;
    if (sigma == p) break;
    const MatrixXd c = product(of_d.rows, of.c), d = product(of_d.rows, of.d);
    // Directions of the state that the outputs without a direct term do not see come first.
    const RowCompression seen = compress_rows(c.topRows(p - sigma).transpose(), rounding);
    const Index rho = seen.rank, nu = n - rho;
    if (rho == 0) {
      of.c = c.bottomRows(sigma);
      of.d = d.bottomRows(sigma);
      break;
    }
    MatrixXd rows(n + sigma, n + m);
    const MatrixXd back = seen.rows.transpose();
    rows << product(product(seen.rows, of.a), back), product(seen.rows, of.b),
        product(c.bottomRows(sigma), back), d.bottomRows(sigma);
    of = {rows.topLeftCorner(nu, nu), rows.topRightCorner(nu, m),
          rows.block(nu, 0, rho + sigma, nu), rows.block(nu, n, rho + sigma, m)};
  }
  return of;
}

Quadruple transposed(const Quadruple& of) {
  return {of.a.transpose(), of.c.transpose(), of.b.transpose(), of.d.transpose()};
}

}  // namespace

std::vector<std::complex<double>> transmission_zeros(const MatrixXd& a, const MatrixXd& b,
                                                     const MatrixXd& c, const MatrixXd& d) {
  if (b.cols() != c.rows() || !a.allFinite() || !b.allFinite() || !c.allFinite()) return {};
  const double size = std::max({a.norm(), b.norm(), c.norm(), d.norm()});
  const double rounding =
      10 * static_cast<double>(a.rows()) * std::numeric_limits<double>::epsilon() * size;
  const Quadruple by_rows = reduced({a, b, c, d}, rounding);
  const Quadruple square = transposed(reduced(transposed(by_rows), rounding));
  if (square.a.rows() == 0) return {};
  MatrixXd matrix = square.a;
  if (square.d.rows() > 0) {
    if (square.d.rows() != square.d.cols()) return {};
    matrix -= product(square.b, solve_consistent(square.d, square.c));
  }
  std::vector<std::complex<double>> zeros = eigenvalues_of(matrix);
  std::sort(zeros.begin(), zeros.end(), [](const auto& p, const auto& q) {
    return p.real() != q.real() ? p.real() > q.real() : p.imag() > q.imag();
  });
  return zeros;
}

}  // namespace bbsim::model
