// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "record/compare.hpp"

#include "api/measure.hpp"
#include "base/number_text.hpp"
#include "base/shown.hpp"
#include "file/cell_table.hpp"
#include "record/solver_allowance.hpp"
#include "record/summarise.hpp"
#include "scenario/measures.hpp"
#include "scenario/unit_doubts.hpp"

namespace bbsim::api {
namespace {

record::Allowances allowances_of(const CompareRequest& request, const file::CellTable& a,
                                 const file::CellTable& b) {
  const record::Allowance standard;
  if (request.rtol || request.atol) {
    return {request.rtol.value_or(standard.rtol), request.atol.value_or(standard.atol)};
  }
  return record::solver_allowances(a, b).value_or(standard);
}

// Warns of columns that one of the files has in another unit than the other, by their looks.
void warn_of_units(const file::CellTable& table, const std::string& name,
                   const file::CellTable& other, const std::string& other_name,
                   std::vector<std::string>& warnings) {
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const file::CellColumn* const beside = other.find(table.names[c]);
    const std::vector<double>& numbers = table.columns[c].numbers;
    if (beside == nullptr || numbers.empty() || beside->numbers.empty()) continue;
    const auto warn = [&](const scenario::Doubt& doubt, const char* does, double one, double two) {
      warnings.push_back("warning: " + name + ": " + shown(table.names[c]) + does +
                         number_text(one) + ", and in " + other_name + " " + number_text(two) +
                         ": it looks like " + std::string(doubt.looks_like));
    };
    if (table.names[c] == "t") {
      const double span = numbers.back() - numbers.front();
      const double its = beside->numbers.back() - beside->numbers.front();
      if (!(its > 0)) continue;
      if (const auto doubt = scenario::doubt_of_span(span, its)) warn(*doubt, " spans ", span, its);
      continue;
    }
    const double largest = scenario::largest_size(numbers);
    const double its = scenario::largest_size(beside->numbers);
    const auto doubt = scenario::doubt_of(largest, table.names[c]);
    if (doubt && !scenario::doubt_of(its, table.names[c])) {
      warn(*doubt, " goes up to ", largest, its);
    }
  }
}

}  // namespace

Compared compare(const CompareRequest& request) {
  const file::CellTable a = file::read_cells(request.a, request.columns);
  const file::CellTable b = file::read_cells(request.b, request.columns);
  const record::Allowances allowances = allowances_of(request, a, b);
  const record::Comparison comparison = record::compare(a, b, allowances, request.columns);
  Compared made{comparison.alike(), to_text(comparison, request.a, request.b, allowances), {}};
  warn_of_units(a, request.a, b, request.b, made.warnings);
  warn_of_units(b, request.b, a, request.a, made.warnings);
  return made;
}

std::string summarize(const SummarizeRequest& request) {
  const file::CellTable table = file::read_cells(request.file);
  const auto groups =
      record::summarise(table, request.file, request.keys,
                        scenario::split_measures(request.measures), request.quantiles);
  return record::to_csv(groups, request.keys, request.quantiles);
}

}  // namespace bbsim::api
