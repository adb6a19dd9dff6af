// The report of `bbsim compare`.
#include <algorithm>
#include <array>
#include <cstdio>

#include "record/compare.hpp"
#include "record/number_text.hpp"

namespace bbsim::record {
namespace {

// Three digits are enough to judge an error by.
std::string rounded(double value) {
  char text[32];
  const int size = std::snprintf(text, sizeof text, "%.3g", value);
  return {text, static_cast<std::size_t>(size)};
}

std::string counted(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

using Line = std::array<std::string, 5>;

std::string table_of(const std::vector<ColumnComparison>& columns) {
  std::vector<Line> lines{{"column", "largest |a - b|", "in row", "times allowed", "rows differ"}};
  for (const ColumnComparison& column : columns) {
    lines.push_back({column.name, rounded(column.largest.difference),
                     std::to_string(column.largest.row), rounded(column.worst.excess),
                     std::to_string(column.different_rows)});
  }
  std::array<std::size_t, std::tuple_size_v<Line>> widths{};
  for (const Line& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  }
  std::string text;
  for (const Line& line : lines) {
    text += line[0] + std::string(widths[0] - line[0].size(), ' ');
    for (std::size_t i = 1; i < line.size(); ++i) {
      text += "  " + std::string(widths[i] - line[i].size(), ' ') + line[i];
    }
    text += '\n';
  }
  return text;
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

}  // namespace

std::string to_text(const Comparison& comparison, const std::string& name_a,
                    const std::string& name_b, const Tolerances& tolerances) {
  std::string text;
  if (comparison.worst) text += table_of(comparison.columns);
  text += missing(comparison.only_in_a, name_a, name_b);
  text += missing(comparison.only_in_b, name_b, name_a);
  if (comparison.rows_a != comparison.rows_b) {
    text += "different: " + name_a + " has " + counted(comparison.rows_a, "row") + ", " + name_b +
            " has " + counted(comparison.rows_b, "row") + "\n";
  }
  if (comparison.worst) {
    const ColumnComparison& column = comparison.columns[*comparison.worst];
    const ValuePair& worst = column.worst;
    if (!worst.alike()) {
      text += "different: worst in column " + column.name + ", row " + std::to_string(worst.row);
      if (comparison.worst_time) text += " (t = " + number_text(*comparison.worst_time) + ")";
      text += ": " + number_text(worst.a) + " in " + name_a + ", " + number_text(worst.b) + " in " +
              name_b + "; the difference is " + rounded(worst.difference) + ", allowed is " +
              rounded(worst.allowance) + "\n";
    }
  }
  if (comparison.alike()) {
    text += "alike: " + name_a + " and " + name_b + ", " +
            counted(comparison.columns.size(), "column") + ", " +
            counted(comparison.rows_a, "row") + ", within rtol " + number_text(tolerances.rtol) +
            " and atol " + number_text(tolerances.atol) + "\n";
  }
  return text;
}

}  // namespace bbsim::record
