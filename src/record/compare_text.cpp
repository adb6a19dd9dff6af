// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The report of `bbsim compare`.
#include <algorithm>
#include <cstdio>
#include <utility>
#include <vector>

#include "base/number_text.hpp"
#include "record/aligned.hpp"
#include "record/compare.hpp"

namespace bbsim::record {
namespace {

std::string counted(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

// Texts that differ have no numeric difference.
std::string difference_text(const ValuePair& pair) {
  return pair.of_text ? "text" : rounded(pair.difference);
}

using Line = std::vector<std::string>;

std::string table_of(const Comparison& comparison, const Allowances& allowances) {
  // The allowance is shown only if it varies between columns.
  const bool own = !allowances.by_column.empty();
  std::vector<Line> lines{{"column", "largest |a - b|", "in row"}};
  if (own) lines[0].emplace_back("allowed");
  lines[0].insert(lines[0].end(), {"times allowed", "rows differ"});
  for (const ColumnComparison& column : comparison.columns) {
    Line line{column.name, difference_text(column.largest), std::to_string(column.largest.row)};
    if (own) line.push_back(column.worst.of_text ? "-" : rounded(column.worst.allowance));
    line.insert(line.end(), {rounded(column.worst.excess), std::to_string(column.different_rows)});
    lines.push_back(std::move(line));
  }
  return aligned(lines);
}

std::string missing(const std::vector<std::string>& names, const std::string& there,
                    const std::string& not_there) {
  std::string text;
  for (const std::string& name : names) {
    text.append("different: column ").append(name).append(" is in ").append(there);
    text.append(" but not in ").append(not_there).append("\n");
  }
  return text;
}

std::string widths_text(const std::vector<WidthDifference>& widths, const std::string& name_a,
                        const std::string& name_b) {
  std::string text;
  for (const WidthDifference& column : widths) {
    text += "different: column " + column.name + " has " + counted(column.a, "number") +
            " a row in " + name_a + ", " + std::to_string(column.b) + " in " + name_b + "\n";
  }
  return text;
}

std::string worst_text(const Comparison& comparison, const std::string& name_a,
                       const std::string& name_b) {
  const ColumnComparison& column = comparison.columns[*comparison.worst];
  const ValuePair& worst = column.worst;
  if (worst.alike()) return "";
  std::string text =
      "different: worst in column " + column.name + ", row " + std::to_string(worst.row);
  if (comparison.worst_time) text += " (t = " + number_text(*comparison.worst_time) + ")";
  const std::string a = worst.of_text ? column.text_a : number_text(worst.a);
  const std::string b = worst.of_text ? column.text_b : number_text(worst.b);
  text += ": " + a + " in " + name_a + ", " + b + " in " + name_b;
  if (worst.of_text) return text + "\n";
  return text + "; the difference is " + rounded(worst.difference) + ", the tolerance " +
         rounded(worst.allowance) + "\n";
}

std::string within(const Allowances& allowances) {
  if (!allowances.reason.empty()) return "within the solver's tolerances";
  return "within rtol " + number_text(allowances.standard.rtol) + " and atol " +
         number_text(allowances.standard.atol);
}

}  // namespace

std::string to_text(const Comparison& comparison, const std::string& name_a,
                    const std::string& name_b, const Allowances& allowances) {
  std::string text;
  if (comparison.worst) text += table_of(comparison, allowances);
  if (!allowances.reason.empty()) text += "allowed: " + allowances.reason + "\n";
  text += missing(comparison.only_in_a, name_a, name_b);
  text += missing(comparison.only_in_b, name_b, name_a);
  text += widths_text(comparison.widths, name_a, name_b);
  if (comparison.rows_a != comparison.rows_b) {
    text += "different: " + name_a + " has " + counted(comparison.rows_a, "row") + ", " + name_b +
            " has " + counted(comparison.rows_b, "row") + "\n";
  }
  if (comparison.worst) text += worst_text(comparison, name_a, name_b);
  if (comparison.alike()) {
    text += "alike: " + name_a + " and " + name_b + ", " +
            counted(comparison.columns.size(), "column") + ", " +
            counted(comparison.rows_a, "row") + ", " + within(allowances) + "\n";
  }
  return text;
}

}  // namespace bbsim::record
