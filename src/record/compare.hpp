// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Compares two tables and finds where they differ most, also by the tolerances of their solvers.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "file/table.hpp"

namespace bbsim::record {

// Values a and b are alike if |a - b| <= atol + rtol max(|a|, |b|), if both are the same infinity,
// or if both are NaN. Texts are alike if they are equal. The defaults allow little more than
// rounding.
struct Allowance {
  double rtol = 1e-9;
  double atol = 1e-12;  // in the unit of the column
};

// The tolerances of all columns.
struct Allowances {
  Allowances() = default;
  Allowances(const Allowance& allowance) : standard(allowance) {}
  Allowances(double rtol, double atol) : standard{rtol, atol} {}

  Allowance standard{};
  std::map<std::string, Allowance> by_column{};  // entries replace the standard one
  std::string reason{};  // reported after "allowed: "; empty for the standard

  [[nodiscard]] const Allowance& of(const std::string& column) const;
};

// A value of a column in the two tables.
struct ValuePair {
  std::size_t row = 0;       // of the data, from 0
  std::size_t position = 0;  // within the row, if it has several numbers
  double a = 0, b = 0;
  double difference = 0;  // |a - b|; infinite if that is not finite and they are not alike
  double allowance = 0;   // atol + rtol max(|a|, |b|); 0 if nothing is allowed
  double excess = 0;      // difference / allowance
  bool of_text = false;   // at least one of the two is a text

  [[nodiscard]] bool alike() const { return difference <= allowance; }
};

struct ColumnComparison {
  std::string name;
  ValuePair largest;  // where the difference is largest
  ValuePair worst;    // where the excess is largest
  std::size_t different_rows = 0;
  std::string text_a{}, text_b{};  // the worst values, if they are texts
};

// A column whose rows have different numbers of values in the two tables.
struct WidthDifference {
  std::string name;
  std::size_t a = 0, b = 0;
};

struct Comparison {
  std::vector<ColumnComparison> columns;  // compared columns, in the order of A or as selected
  std::vector<std::string> only_in_a, only_in_b;
  std::vector<WidthDifference> widths;
  std::size_t rows_a = 0, rows_b = 0;  // only common rows are compared
  std::optional<std::size_t> worst;    // index into columns; empty if there are no rows
  std::optional<double> worst_time;    // t in A where the worst column is worst

  [[nodiscard]] bool alike() const;
};

// Compares columns by name, in any order. `columns` selects some of them. If it is empty, all are
// compared, and a column that one table lacks is a difference. Throws InputError if a table lacks a
// selected column, and for a tolerance that is negative or not finite.
[[nodiscard]] Comparison compare(const file::Table& a, const file::Table& b,
                                 const Allowances& allowances = {},
                                 const std::vector<std::string>& columns = {});

// The report of `bbsim compare`: a table of the columns, then the verdict.
[[nodiscard]] std::string to_text(const Comparison& comparison, const std::string& name_a,
                                  const std::string& name_b, const Allowances& allowances);

// Rounds to three digits, which suffice to judge an error.
[[nodiscard]] std::string rounded(double value);

// Aligns lines of equal length: the first field to the left, the others to the right.
[[nodiscard]] std::string aligned(const std::vector<std::vector<std::string>>& lines);

// How far two results may differ. Reads HDF5 attributes: the tolerances rtol and atol, or the bound
// error_bound on the error of positions. Empty if neither file has any, as with CSV.
//
// Tolerances hold for a step. The errors of all steps together may be a hundred times as large, as
// in the golden files. Each file may therefore be off, in a column, by
//
//     100 (rtol size + atol unit)
//
// and two files by the sum. `size` is the largest value in any column of the same kind, because an
// error of x may pass to y. `unit` is the change of the column per unit of the integrated state: 1
// for most columns; 1/r for the spin, which is integrated as r spin; 1/r times the length of the
// run for gamma, the integral of the spin; and omega_n^2 + 2 zeta omega_n for the gimbal's
// accelerations under a servo. Columns that are not computed from states, such as t, a sweep's keys
// and texts, have the standard tolerances.
[[nodiscard]] std::optional<Allowances> solver_allowances(const file::Table& a,
                                                          const file::Table& b);

}  // namespace bbsim::record
