// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Transmission zeros of a linear system.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "model/control/linear_system.hpp"
#include "model/eigenvalues.hpp"

namespace bbsim::model {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

// A sum with the size of its largest term: a remainder of terms that cancel counts as 0.
struct Sum {
  double value = 0, of = 0;

  [[nodiscard]] bool is_zero() const {
    // Entries carry the rounding of an exponential and of the elimination.
    constexpr double rounding = 1e-12;
    return !(std::abs(value) > rounding * of);
  }
  // Whether no digit of the value is known.
  [[nodiscard]] bool is_rounding() const {
    return !(std::abs(value) > 32 * std::numeric_limits<double>::epsilon() * of);
  }
};

Sum product(const Sum& a, const Sum& b) {
  return {a.value * b.value, std::max(a.of * std::abs(b.value), std::abs(a.value) * b.of)};
}

Sum ratio(const Sum& a, const Sum& b) {
  const double value = a.value / b.value;
  return {value, std::max(a.of, std::abs(value) * b.of) / std::abs(b.value)};
}

// [A, B; C, D] with this many states. Rows are states, then outputs; columns are states, then
// inputs.
struct Pencil {
  Index states;
  Eigen::Matrix<Sum, Eigen::Dynamic, Eigen::Dynamic> at;

  [[nodiscard]] Pencil transposed() const { return {states, at.transpose()}; }
};

void add(Sum& to, const Sum& factor, const Sum& what, double sign) {
  const Sum more = product(factor, what);
  to = {to.value + sign * more.value, std::max(to.of, more.of)};
}

struct Place {
  Index row, column;
};

// The largest nonzero entry in these rows and columns.
std::optional<Place> largest_of(const Pencil& of, const std::vector<Index>& rows,
                                const std::vector<Index>& columns) {
  std::optional<Place> place;
  double largest = 0;
  for (const Index i : rows) {
    for (const Index j : columns) {
      const Sum& entry = of.at(i, j);
      if (entry.is_zero() || !(std::abs(entry.value) > largest)) continue;
      largest = std::abs(entry.value);
      place = Place{i, j};
    }
  }
  return place;
}

std::vector<Index> range(Index from, Index to) {
  std::vector<Index> all;
  for (Index i = from; i < to; ++i) all.push_back(i);
  return all;
}

// Subtracts a multiple of the pivot's row from `row`, which becomes 0 in the pivot's column.
void eliminate(Pencil& of, const Place& pivot, Index row) {
  if (of.at(row, pivot.column).value == 0) return;
  const Sum factor = ratio(of.at(row, pivot.column), of.at(pivot.row, pivot.column));
  for (Index j = 0; j < of.at.cols(); ++j) {
    if (j != pivot.column) add(of.at(row, j), factor, of.at(pivot.row, j), -1);
  }
  of.at(row, pivot.column) = {};
}

// Returns D's pivots. The other rows of outputs, `without`, become 0 in the columns of inputs.
std::vector<Place> compress_inputs(Pencil& of, std::vector<Index>& without) {
  without = range(of.states, of.at.rows());
  std::vector<Index> columns = range(of.states, of.at.cols());
  std::vector<Place> pivots;
  while (const auto pivot = largest_of(of, without, columns)) {
    std::erase(without, pivot->row);
    std::erase(columns, pivot->column);
    for (const Index row : without) eliminate(of, *pivot, row);
    pivots.push_back(*pivot);
  }
  for (const Index row : without) {
    for (Index j = of.states; j < of.at.cols(); ++j) of.at(row, j) = {};
  }
  return pivots;
}

// Changes states so that these rows of outputs depend on the returned states alone.
std::vector<Index> compress_states(Pencil& of, std::vector<Index> outputs,
                                   std::vector<Index>& unseen) {
  unseen = range(0, of.states);
  std::vector<Index> seen;
  while (const auto pivot = largest_of(of, outputs, unseen)) {
    std::erase(outputs, pivot->row);
    std::erase(unseen, pivot->column);
    const Index k = pivot->column;
    for (const Index j : unseen) {
      if (of.at(pivot->row, j).value == 0) continue;
      // x_k + f x_j replaces x_k as a state.
      const Sum f = ratio(of.at(pivot->row, j), of.at(pivot->row, k));
      for (Index i = 0; i < of.at.rows(); ++i) add(of.at(i, j), f, of.at(i, k), -1);
      for (Index i = 0; i < of.at.cols(); ++i) add(of.at(k, i), f, of.at(j, i), 1);
      of.at(pivot->row, j) = {};
    }
    for (const Index row : outputs) of.at(row, k) = {};
    seen.push_back(k);
  }
  return seen;
}

// Removes states that zeros do not depend on, until D has full row rank.
Pencil reduced(Pencil of) {
  while (of.states > 0) {
    std::vector<Index> without, unseen;
    const std::vector<Place> pivots = compress_inputs(of, without);
    if (without.empty()) break;
    const std::vector<Index> seen = compress_states(of, without, unseen);
    // Leave out outputs that see nothing any more.
    std::vector<Index> kept = unseen, columns = unseen;
    kept.insert(kept.end(), seen.begin(), seen.end());
    for (const Place& pivot : pivots) kept.push_back(pivot.row);
    for (Index j = of.states; j < of.at.cols(); ++j) columns.push_back(j);
    of = Pencil{std::ssize(unseen), of.at(kept, columns)};
    if (seen.empty()) break;
  }
  return of;
}

// Changes units by powers of 2: of states, so that a row and its column are similar in size; of
// inputs and outputs, so that their largest entry is about 1.
void balance(MatrixXd& all, Index states) {
  constexpr int enough = 100;
  bool changes = true;
  const auto power = [](double of) { return std::exp2(std::round(std::log2(of))); };
  for (int pass = 0; pass < enough && changes; ++pass) {
    changes = false;
    for (Index i = 0; i < all.rows(); ++i) {
      double row = 0, column = 0;
      for (Index j = 0; j < all.cols(); ++j) {
        if (j == i && i < states) continue;
        row = std::max(row, std::abs(all(i, j)));
        column = std::max(column, std::abs(all(j, i)));
      }
      double of_row = 1, of_column = 1;
      if (i >= states) {
        if (row > 0) of_row = power(1 / row);
        if (column > 0) of_column = power(1 / column);
      } else if (row > 0 && column > 0) {
        of_column = std::exp2(std::round((std::log2(row) - std::log2(column)) / 2));
        of_row = 1 / of_column;
      }
      if ((of_row == 1 && of_column == 1) || !std::isfinite(of_row) || !std::isfinite(of_column)) {
        continue;
      }
      changes = true;
      all.row(i) *= of_row;
      all.col(i) *= of_column;
    }
  }
}

}  // namespace

std::vector<std::complex<double>> transmission_zeros(const MatrixXd& a, const MatrixXd& b,
                                                     const MatrixXd& c, const MatrixXd& d) {
  const Index n = a.rows(), inputs = b.cols();
  if (inputs != c.rows() || !a.allFinite() || !b.allFinite() || !c.allFinite() || !d.allFinite()) {
    return {};
  }
  MatrixXd all(n + inputs, n + inputs);
  all << a, b, c, d;
  balance(all, n);
  const Pencil pencil{n, all.unaryExpr([](double entry) { return Sum{entry, std::abs(entry)}; })};
  Pencil square = reduced(reduced(pencil).transposed()).transposed();
  const Index left = square.states;
  if (left == 0 || square.at.rows() != square.at.cols()) return {};
  // A - B D^-1 C.
  std::vector<Index> without;
  const std::vector<Place> pivots = compress_inputs(square, without);
  if (!without.empty()) return {};
  for (const Place& pivot : pivots) {
    for (Index row = 0; row < left; ++row) eliminate(square, pivot, row);
  }
  const MatrixXd matrix = square.at.topLeftCorner(left, left).unaryExpr([](const Sum& entry) {
    return entry.is_rounding() ? 0.0 : entry.value;
  });
  std::vector<std::complex<double>> zeros =
      left > most_exact ? eigenvalues_of(matrix) : exact_eigenvalues(matrix);
  std::sort(zeros.begin(), zeros.end(), [](const auto& p, const auto& q) {
    return p.real() != q.real() ? p.real() > q.real() : p.imag() > q.imag();
  });
  return zeros;
}

}  // namespace bbsim::model
