// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "record/compare.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "base/error.hpp"
#include "base/number_text.hpp"
#include "base/real.hpp"
#include "base/text.hpp"

namespace bbsim::record {

namespace {

ValuePair compare_numbers(double a, double b, const Allowance& allowance) {
  ValuePair pair{.a = a, .b = b};
  if (std::isfinite(a) && std::isfinite(b)) {
    pair.allowance = allowance.atol + allowance.rtol * std::max(std::abs(a), std::abs(b));
  }
  if (a == b || (std::isnan(a) && std::isnan(b))) return pair;
  pair.difference = std::abs(a - b);
  if (!std::isfinite(pair.difference)) {  // also after an overflow
    pair.difference = infinity;
    pair.allowance = 0;
  }
  pair.excess = pair.difference / pair.allowance;  // infinite if nothing is allowed
  return pair;
}

// A number and a text differ, even if they look alike.
ValuePair compare_texts(const file::Column& a, const file::Column& b, std::size_t i) {
  ValuePair pair{.of_text = true};
  if (a.has_text(i) && b.has_text(i) && a.texts[i] == b.texts[i]) return pair;
  pair.difference = infinity;
  pair.excess = infinity;
  return pair;
}

bool is_worse(const ValuePair& a, const ValuePair& b) {
  // The excess may round to 1 from either side, so alike() decides first.
  const bool a_differs = !a.alike();
  const bool b_differs = !b.alike();
  return std::tie(a_differs, a.excess, a.difference) > std::tie(b_differs, b.excess, b.difference);
}

std::string as_text(const file::Column& column, std::size_t i) {
  return column.has_text(i) ? '"' + column.texts[i] + '"' : number_text(column.numbers[i]);
}

// The two columns have equal width.
ColumnComparison compare_column(const std::string& name, const file::Column& a,
                                const file::Column& b, const Allowance& allowance) {
  ColumnComparison result;
  result.name = name;
  const std::size_t size = std::min(a.numbers.size(), b.numbers.size());
  std::size_t worst = 0;
  for (std::size_t row = 0, i = 0; i < size; ++row) {
    bool alike = true;
    for (std::size_t position = 0; position < a.width && i < size; ++position, ++i) {
      ValuePair pair = a.has_text(i) || b.has_text(i)
                           ? compare_texts(a, b, i)
                           : compare_numbers(a.numbers[i], b.numbers[i], allowance);
      pair.row = row;
      pair.position = position;
      alike = alike && pair.alike();
      if (i == 0 || pair.difference > result.largest.difference) result.largest = pair;
      if (i == 0 || is_worse(pair, result.worst)) {
        result.worst = pair;
        worst = i;
      }
    }
    if (!alike) ++result.different_rows;
  }
  if (result.worst.of_text) {
    result.text_a = as_text(a, worst);
    result.text_b = as_text(b, worst);
  }
  return result;
}

void require_column(const file::Table& table, const char* which, const std::string& name) {
  if (table.find(name) != nullptr) return;
  throw InputError("--columns: the " + std::string(which) + " file has no column \"" + name +
                   "\"; it has " + joined(table.names()));
}

void require_tolerance(const char* name, double value) {
  if (std::isfinite(value) && value >= 0) return;
  throw InputError("--" + std::string(name) + ": found " + number_text(value) +
                   "; a tolerance is finite and not negative");
}

// t in the worst row; in a series, t at the worst position.
std::optional<double> time_of(const file::Table& table, const ColumnComparison& column) {
  const file::Column* const time = table.find("t");
  if (time == nullptr || time->width != table.find(column.name)->width) return {};
  const std::size_t i = time->width > 1 ? column.worst.position : column.worst.row;
  if (i >= time->numbers.size() || time->has_text(i)) return {};
  return time->numbers[i];
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

const Allowance& Allowances::of(const std::string& column) const {
  const auto own = by_column.find(column);
  return own == by_column.end() ? standard : own->second;
}

bool Comparison::alike() const {
  return rows_a == rows_b && only_in_a.empty() && only_in_b.empty() && widths.empty() &&
         std::all_of(columns.begin(), columns.end(),
                     [](const ColumnComparison& column) { return column.different_rows == 0; });
}

Comparison compare(const file::Table& a, const file::Table& b, const Allowances& allowances,
                   const std::vector<std::string>& columns) {
  require_tolerance("rtol", allowances.standard.rtol);
  require_tolerance("atol", allowances.standard.atol);
  Comparison result;
  result.rows_a = a.rows;
  result.rows_b = b.rows;
  for (const std::string& name : columns) {
    require_column(a, "first", name);
    require_column(b, "second", name);
  }
  if (columns.empty()) {
    for (const file::Column& column : b.columns) {
      if (a.find(column.name) == nullptr) result.only_in_b.push_back(column.name);
    }
  }
  for (const std::string& name : columns.empty() ? a.names() : columns) {
    const file::Column& in_a = *a.find(name);
    const file::Column* in_b = b.find(name);
    if (in_b == nullptr) {
      result.only_in_a.push_back(name);
      continue;
    }
    if (in_a.width != in_b->width) {
      result.widths.push_back({name, in_a.width, in_b->width});
      continue;
    }
    result.columns.push_back(compare_column(name, in_a, *in_b, allowances.of(name)));
    const std::size_t last = result.columns.size() - 1;
    if (!result.worst ||
        is_worse(result.columns[last].worst, result.columns[*result.worst].worst)) {
      result.worst = last;
    }
  }
  if (std::min(result.rows_a, result.rows_b) == 0) result.worst.reset();
  if (result.worst) result.worst_time = time_of(a, result.columns[*result.worst]);
  return result;
}

std::string rounded(double value) {
  char text[32];
  const int size = std::snprintf(text, sizeof text, "%.3g", value);
  return {text, static_cast<std::size_t>(size)};
}

std::string aligned(const std::vector<std::vector<std::string>>& lines) {
  std::vector<std::size_t> widths(lines[0].size());
  for (const auto& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  }
  std::string text;
  for (const auto& line : lines) {
    text += line[0] + std::string(widths[0] - line[0].size(), ' ');
    for (std::size_t i = 1; i < line.size(); ++i) {
      text += "  " + std::string(widths[i] - line[i].size(), ' ') + line[i];
    }
    text += '\n';
  }
  return text;
}

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
