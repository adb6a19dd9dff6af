// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "record/compare.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/number_text.hpp"
#include "base/shown.hpp"
#include "commands.hpp"
#include "file/cell_table.hpp"
#include "record/solver_allowance.hpp"
#include "scenario/unit_doubts.hpp"
#include "terminal.hpp"

namespace bbsim::app {
namespace {

struct CompareOptions {
  std::string a, b;
  std::optional<double> rtol, atol;
  std::vector<std::string> columns;
};

record::Allowances allowances_of(const CompareOptions& options, const file::CellTable& a,
                                 const file::CellTable& b) {
  const record::Allowance standard;
  if (options.rtol || options.atol) {
    return {options.rtol.value_or(standard.rtol), options.atol.value_or(standard.atol)};
  }
  return record::solver_allowances(a, b).value_or(standard);
}

// Warns of columns that one of the files has in another unit than the other, by their looks.
void warn_of_units(const file::CellTable& table, const std::string& name,
                   const file::CellTable& other, const std::string& other_name) {
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const file::CellColumn* const beside = other.find(table.names[c]);
    const std::vector<double>& numbers = table.columns[c].numbers;
    if (beside == nullptr || numbers.empty() || beside->numbers.empty()) continue;
    const auto warn = [&](const scenario::Doubt& doubt, const char* does, double one, double two) {
      say("warning: " + name + ": " + shown(table.names[c]) + does + number_text(one) +
          ", and in " + other_name + " " + number_text(two) + ": it looks like " +
          std::string(doubt.looks_like));
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

ExitCode run_compare(const CompareOptions& options, const Options& all) {
  file::Outputs outputs;
  outputs.reads(options.a, "A");
  outputs.reads(options.b, "B");
  prints(outputs);
  for (const std::string& file : {options.a, options.b}) say_if_waiting(file, "a CSV", all.quiet);
  const file::CellTable a = file::read_cells(options.a, options.columns);
  const file::CellTable b = file::read_cells(options.b, options.columns);
  const record::Allowances allowances = allowances_of(options, a, b);
  const record::Comparison comparison = record::compare(a, b, allowances, options.columns);
  print(to_text(comparison, options.a, options.b, allowances));
  if (!all.quiet) {
    warn_of_units(a, options.a, b, options.b);
    warn_of_units(b, options.b, a, options.a);
  }
  return comparison.alike() ? ExitCode::done : ExitCode::ended_early;
}

}  // namespace

void add_compare(Command& command, const Options& all) {
  command.footer(
      "bbsim matches columns by name and rows by position. Values a and b are alike if |a - b| <= "
      "atol + rtol max(|a|, |b|). NaN is like NaN, and an infinity like the same infinity. Texts, "
      "such as a sweep's status, must be equal. Without --rtol and --atol, the tolerances follow "
      "from the solver settings that HDF5 files carry; for other files they are 1e-9 and 1e-12.\n"
      "The exit code is 0 if the files are alike, 1 if they differ, 2 if one cannot be read or "
      "lacks a named column.");
  auto options = std::make_shared<CompareOptions>();
  command.option("A", options->a, "CSV, HDF5 (.h5, .hdf5), or - for CSV on standard input")
      .required();
  command.option("B", options->b, "the file to compare it with").required();
  command
      .option("--rtol", options->rtol, "tolerance relative to the larger value; default: see below")
      .takes("R");
  command
      .option("--atol", options->atol,
              "absolute tolerance, in the column's unit; default: see below")
      .takes("A");
  command
      .option("--columns", options->columns,
              "compare only these columns; default: all, and a column that only one file has is a "
              "difference")
      .takes("NAME,...")
      .parted_by_commas();  // a file may follow
  command.does([options, &all] { return run_compare(*options, all); });
}

}  // namespace bbsim::app
