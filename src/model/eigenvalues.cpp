// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/eigenvalues.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "base/quad.hpp"

namespace bbsim::model {
namespace {

// The values times the unit; empty if one is beyond the range of doubles.
std::vector<std::complex<double>> in_units(std::vector<std::complex<double>> values, double unit) {
  for (auto& value : values) {
    value *= unit;
    if (!std::isfinite(value.real()) || !std::isfinite(value.imag())) return {};
  }
  return values;
}

}  // namespace

std::vector<std::complex<double>> eigenvalues_of(const Eigen::MatrixXd& matrix) {
  if (!matrix.allFinite()) return {};
  // Eigen's solver does not balance: rounding of a stiff servo's entries would reach all others.
  const Eigen::MatrixXd even = balanced(matrix);
  const double unit = unit_of(even);
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(even / unit, false);
  if (solver.info() != Eigen::Success) return {};
  return in_units({solver.eigenvalues().begin(), solver.eigenvalues().end()}, unit);
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

namespace {

using Values = std::vector<std::complex<double>>;

// A square matrix of quads, with Householder reflections of its rows and columns.
class QuadMatrix {
 public:
  explicit QuadMatrix(const Eigen::MatrixXd& of)
      : n_(static_cast<int>(of.rows())), entries_(static_cast<std::size_t>(n_ * n_)) {
    for (int i = 0; i < n_; ++i) {
      for (int j = 0; j < n_; ++j) (*this)(i, j) = of(i, j);
    }
  }

  [[nodiscard]] int size() const { return n_; }
  Quad& operator()(int i, int j) { return entries_[static_cast<std::size_t>(i * n_ + j)]; }

  // Replaces M by p M p within rows and columns low to high. The reflection p acts from `first` on
  // and maps `vector` to a multiple of (1, 0, ...).
  void reflect(std::vector<Quad> vector, int first, int low, int high) {
    Quad square(0.0);
    for (const Quad& component : vector) square += component * component;
    const Quad length = root_along(square, vector[0]);
    if (length == Quad(0.0)) return;
    vector[0] += length;
    const Quad scale = length * vector[0];  // half the new vector's squared length
    const auto count = static_cast<int>(vector.size());
    const auto apply = [&](const auto& entry) {
      Quad along(0.0);
      for (int k = 0; k < count; ++k) along += vector[static_cast<std::size_t>(k)] * entry(k);
      along /= scale;
      for (int k = 0; k < count; ++k) entry(k) -= along * vector[static_cast<std::size_t>(k)];
    };
    for (int j = low; j <= high; ++j) {
      apply([&](int k) -> Quad& { return (*this)(first + k, j); });
    }
    for (int i = low; i <= high; ++i) {
      apply([&](int k) -> Quad& { return (*this)(i, first + k); });
    }
  }

 private:
  int n_;
  std::vector<Quad> entries_;
};

void make_hessenberg(QuadMatrix& m) {
  for (int k = 0; k + 2 < m.size(); ++k) {
    std::vector<Quad> below;
    for (int i = k + 1; i < m.size(); ++i) below.push_back(m(i, k));
    m.reflect(std::move(below), k + 1, 0, m.size() - 1);
    for (int i = k + 2; i < m.size(); ++i) m(i, k) = 0.0;
  }
}

// Appends the eigenvalues of [a, b; c, d].
void add_pair(Quad a, Quad b, Quad c, Quad d, Values& values) {
  const Quad half = (a - d) / Quad(2.0), middle = (a + d) / Quad(2.0), square = half * half + b * c;
  if (square < Quad(0.0)) {
    const double apart = plain(root_along(-square, Quad(1.0)));
    values.emplace_back(plain(middle), apart);
    values.emplace_back(plain(middle), -apart);
    return;
  }
  // First the value farther from 0, then the other from the product, which does not cancel.
  const Quad far = middle + root_along(square, middle);
  values.emplace_back(plain(far), 0);
  const Quad product = a * d - b * c;
  values.emplace_back(far == Quad(0.0) ? 0 : plain(product / far), 0);
}

// A double-shift step of Francis's implicit QR, in rows and columns low to high: Golub and Van
// Loan, Matrix Computations, algorithm 7.5.1.
void step(QuadMatrix& m, int low, int high, Quad sum, Quad product) {
  std::vector<Quad> bulge{
      m(low, low) * m(low, low) + m(low, low + 1) * m(low + 1, low) - sum * m(low, low) + product,
      m(low + 1, low) * (m(low, low) + m(low + 1, low + 1) - sum),
      m(low + 1, low) * m(low + 2, low + 1)};
  for (int k = low; k < high; ++k) {
    const int rows = std::min(3, high - k + 1);
    bulge.resize(static_cast<std::size_t>(rows));
    m.reflect(bulge, k, low, high);
    for (int i = k + 1; k > low && i < k + rows; ++i) m(i, k - 1) = 0.0;
    for (int i = 0; i < rows && k + 1 + i <= high; ++i) {
      bulge[static_cast<std::size_t>(i)] = m(k + 1 + i, k);
    }
  }
}

Values eigenvalues_of_hessenberg(QuadMatrix& m) {
  Quad largest(0.0);
  for (int i = 0; i < m.size(); ++i) {
    for (int j = 0; j < m.size(); ++j) largest = std::max(largest, abs(m(i, j)));
  }
  Values values;
  int passes = 0;
  for (int high = m.size() - 1; high >= 0;) {
    int low = high;
    for (; low > 0; --low) {
      Quad beside = abs(m(low - 1, low - 1)) + abs(m(low, low));
      if (beside == Quad(0.0)) beside = largest;
      if (abs(m(low, low - 1)) > Quad(Quad::epsilon()) * beside) continue;
      m(low, low - 1) = 0.0;
      break;
    }
    if (low == high) {
      values.emplace_back(plain(m(high, high)), 0);
      high -= 1;
      passes = 0;
    } else if (low == high - 1) {
      add_pair(m(low, low), m(low, high), m(high, low), m(high, high), values);
      high -= 2;
      passes = 0;
    } else {
      constexpr int most = 200, another = 11;
      if (++passes > most) return {};
      const Quad a = m(high - 1, high - 1), b = m(high - 1, high), c = m(high, high - 1),
                 d = m(high, high);
      // Use other shifts from time to time, in case the corner's do not converge.
      const Quad jolt = abs(c) + abs(m(high - 1, high - 2));
      if (passes % another == 0) {
        step(m, low, high, Quad(1.5) * jolt, jolt * jolt);
      } else {
        step(m, low, high, a + d, a * d - b * c);
      }
    }
  }
  return values;
}

}  // namespace

Values exact_eigenvalues(const Eigen::MatrixXd& matrix) {
  if (!matrix.allFinite()) return {};
  // Square roots go through doubles, so scale squares of entries into their range.
  const Eigen::MatrixXd even = balanced(matrix);
  const double unit = unit_of(even);
  QuadMatrix m(even / unit);
  make_hessenberg(m);
  return in_units(eigenvalues_of_hessenberg(m), unit);
}

double exact_rounding(Eigen::Index size) {
  return 10 * static_cast<double>(size) * Quad::epsilon();
}

}  // namespace bbsim::model
