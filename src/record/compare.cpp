#include "record/compare.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "base/error.hpp"
#include "record/number_text.hpp"

namespace bbsim::record {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

ValuePair compare_values(std::size_t row, double a, double b, const Tolerances& tolerances) {
  ValuePair pair{row, a, b};
  if (std::isfinite(a) && std::isfinite(b)) {
    pair.allowance = tolerances.atol + tolerances.rtol * std::max(std::abs(a), std::abs(b));
  }
  if (a == b || (std::isnan(a) && std::isnan(b))) return pair;
  pair.difference = std::abs(a - b);
  if (!std::isfinite(pair.difference)) {  // also what overflows
    pair.difference = infinity;
    pair.allowance = 0;
  }
  pair.excess = pair.difference / pair.allowance;  // infinite if nothing is allowed
  return pair;
}

bool is_worse(const ValuePair& one, const ValuePair& other) {
  // A quotient may round to 1 on either side of it.
  const bool one_differs = !one.alike();
  const bool other_differs = !other.alike();
  return std::tie(one_differs, one.excess, one.difference) >
         std::tie(other_differs, other.excess, other.difference);
}

ColumnComparison compare_column(const std::string& name, const std::vector<double>& a,
                                const std::vector<double>& b, const Tolerances& tolerances) {
  ColumnComparison result{name, {}, {}, 0};
  const std::size_t rows = std::min(a.size(), b.size());
  for (std::size_t row = 0; row < rows; ++row) {
    const ValuePair pair = compare_values(row, a[row], b[row], tolerances);
    if (row == 0 || pair.difference > result.largest.difference) result.largest = pair;
    if (row == 0 || is_worse(pair, result.worst)) result.worst = pair;
    if (!pair.alike()) ++result.different_rows;
  }
  return result;
}

const std::vector<double>* find(const TableData& table, const std::string& name) {
  const auto at = std::find(table.names.begin(), table.names.end(), name);
  if (at == table.names.end()) return nullptr;
  return &table.columns[static_cast<std::size_t>(at - table.names.begin())];
}

std::size_t row_count(const TableData& table) {
  return table.columns.empty() ? 0 : table.columns.front().size();
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

void require_column(const TableData& table, const char* which, const std::string& name) {
  if (find(table, name) != nullptr) return;
  throw InputError("--columns: the " + std::string(which) + " file has no column \"" + name +
                   "\"; it has " + joined(table.names));
}

void require_tolerance(const char* name, double value) {
  if (std::isfinite(value) && value >= 0) return;
  throw InputError("--" + std::string(name) + ": found " + number_text(value) +
                   "; a tolerance is finite and not negative");
}

}  // namespace

bool Comparison::alike() const {
  return rows_a == rows_b && only_in_a.empty() && only_in_b.empty() &&
         std::all_of(columns.begin(), columns.end(),
                     [](const ColumnComparison& column) { return column.different_rows == 0; });
}

Comparison compare(const TableData& a, const TableData& b, const Tolerances& tolerances,
                   const std::vector<std::string>& columns) {
  require_tolerance("rtol", tolerances.rtol);
  require_tolerance("atol", tolerances.atol);
  Comparison result;
  result.rows_a = row_count(a);
  result.rows_b = row_count(b);
  for (const std::string& name : columns) {
    require_column(a, "first", name);
    require_column(b, "second", name);
  }
  if (columns.empty()) {
    for (const std::string& name : b.names) {
      if (find(a, name) == nullptr) result.only_in_b.push_back(name);
    }
  }
  for (const std::string& name : columns.empty() ? a.names : columns) {
    const std::vector<double>* in_b = find(b, name);
    if (in_b == nullptr) {
      result.only_in_a.push_back(name);
      continue;
    }
    result.columns.push_back(compare_column(name, *find(a, name), *in_b, tolerances));
    const std::size_t last = result.columns.size() - 1;
    if (!result.worst ||
        is_worse(result.columns[last].worst, result.columns[*result.worst].worst)) {
      result.worst = last;
    }
  }
  if (std::min(result.rows_a, result.rows_b) == 0) result.worst.reset();
  if (const std::vector<double>* time = find(a, "t"); time != nullptr && result.worst) {
    result.worst_time = (*time)[result.columns[*result.worst].worst.row];
  }
  return result;
}

}  // namespace bbsim::record
