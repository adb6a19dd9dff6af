// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/eigenvalues.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/quad.hpp"

// What Eigen's solver asks of a number type.
template <>
struct std::numeric_limits<bbsim::Quad> : std::numeric_limits<double> {
  static constexpr bbsim::Quad epsilon() { return bbsim::Quad::epsilon(); }
};

namespace bbsim {

static Quad sqrt(const Quad& square) {
  return root_along(square, Quad(1.0));
}

}  // namespace bbsim

namespace bbsim::model {
namespace {

using std::abs;

template <class Real>
std::vector<std::complex<double>> eigenvalues_in(const Eigen::MatrixXd& matrix) {
  if (matrix.size() == 0 || !matrix.allFinite()) return {};
  // Eigen's solver does not balance: rounding of a stiff servo's entries would reach all others.
  // The unit keeps squares in the range of doubles, through which a Quad's roots go.
  const Eigen::MatrixXd even = balanced(matrix);
  const double unit = unit_of(even);
  using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
  const Eigen::RealSchur<Matrix> schur((even / unit).cast<Real>(), false);
  if (schur.info() != Eigen::Success) return {};
  const Matrix& t = schur.matrixT();
  std::vector<std::complex<double>> values;
  const auto add = [&](const Real& real, const Real& imaginary) {
    values.push_back(unit * std::complex<double>(value_of(real), value_of(imaginary)));
  };
  // A block of two rows has a complex pair.
  for (Eigen::Index i = 0; i < t.rows(); ++i) {
    if (i + 1 == t.rows() || t(i + 1, i) == Real(0.0)) {
      add(t(i, i), Real(0.0));
      continue;
    }
    const Real half = Real(0.5) * (t(i, i) - t(i + 1, i + 1)), middle = t(i + 1, i + 1) + half;
    const Real size = std::max({abs(half), abs(t(i + 1, i)), abs(t(i, i + 1))});  // none overflows
    const Real square = (half / size) * (half / size) + t(i + 1, i) / size * (t(i, i + 1) / size);
    const Real apart = size * root_along(abs(square), Real(1.0));
    add(middle, apart);
    add(middle, -apart);
    ++i;
  }
  for (const auto& value : values) {
    if (!std::isfinite(value.real()) || !std::isfinite(value.imag())) return {};
  }
  return values;
}

}  // namespace

std::vector<std::complex<double>> eigenvalues_of(const Eigen::MatrixXd& matrix) {
  return eigenvalues_in<double>(matrix);
}

double unit_of(const Eigen::MatrixXd& matrix) {
  const double largest = matrix.size() == 0 ? 0 : matrix.cwiseAbs().maxCoeff();
  return largest > 0 ? std::exp2(std::ilogb(largest)) : 1;
}

Eigen::MatrixXd balanced(const Eigen::MatrixXd& matrix, Eigen::VectorXd* scale) {
  Eigen::MatrixXd result = matrix;
  const Eigen::Index n = result.rows();
  if (scale != nullptr) scale->setOnes(n);
  constexpr int enough = 100;
  bool changes = true;
  for (int pass = 0; pass < enough && changes; ++pass) {
    changes = false;
    for (Eigen::Index i = 0; i < n; ++i) {
      double row = 0, column = 0;
      for (Eigen::Index j = 0; j < n; ++j) {
        if (j == i) continue;
        row += std::abs(result(i, j));
        column += std::abs(result(j, i));
      }
      if (!(row > 0 && column > 0)) continue;
      const double factor = std::exp2(std::round((std::log2(row) - std::log2(column)) / 2));
      if (!(column * factor + row / factor < 0.95 * (row + column))) continue;
      changes = true;
      result.row(i) /= factor;
      result.col(i) *= factor;
      if (scale != nullptr) (*scale)[i] *= factor;
    }
  }
  return result;
}

std::vector<std::complex<double>> exact_eigenvalues(const Eigen::MatrixXd& matrix) {
  return eigenvalues_in<Quad>(matrix);
}

double exact_rounding(Eigen::Index size) {
  return 10 * static_cast<double>(size) * Quad::epsilon();
}

}  // namespace bbsim::model
