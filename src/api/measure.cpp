// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/measure.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string_view>

#include "api/run.hpp"
#include "base/number_text.hpp"
#include "base/quoted.hpp"
#include "file/cell_table.hpp"
#include "file/table_writer.hpp"
#include "record/compare.hpp"
#include "record/log_distance.hpp"
#include "record/measure_rows.hpp"
#include "record/solver_allowance.hpp"
#include "record/summarise.hpp"
#include "results/read_result.hpp"
#include "scenario/columns.hpp"
#include "scenario/log_columns.hpp"
#include "scenario/measures.hpp"

namespace bbsim::api {
namespace {

// A column of words, such as a log may have for other readers.
struct Words {
  std::string column, first;
  std::size_t row = 0;  // of the first
};

// Returns the columns of numbers; puts the first word of each other column into `others`.
file::TableData numbers_of(results::Result result, std::vector<Words>& others) {
  if (result.is_sweep()) {
    throw InputError(result.file +
                     ": is a sweep; allowed: the result of a run. Measures of a sweep "
                     "are its columns: bbsim summarize " +
                     result.file);
  }
  file::TableData table;
  for (results::Column& column : result.columns) {
    if (column.is_text()) {
      const auto is_word = [&](std::size_t row) {
        const bool number = row < column.numbers.size() && !std::isnan(column.numbers[row]);
        return !number && !column.texts[row].empty();
      };
      std::size_t row = 0;
      while (row + 1 < column.texts.size() && !is_word(row)) ++row;
      others.push_back({column.name, column.texts[row], row + 1});
      continue;
    }
    table.names.push_back(column.name);
    table.columns.push_back(std::move(column.numbers));
  }
  return table;
}

// Whether `text` contains the name as a separate part, as x in "max_x", "x.Peak" and "when x=1".
bool has_name(const std::string& text, const std::string& name) {
  const auto is_letter = [&](std::size_t at) {
    return at < text.size() && std::isalnum(static_cast<unsigned char>(text[at])) != 0;
  };
  for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + 1)) {
    if ((at == 0 || !is_letter(at - 1)) && !is_letter(at + name.size())) return true;
  }
  return false;
}

// Throws a message about the first word in `t` or a requested column, else `error`.
[[noreturn]] void refuse(const InputError& error, const std::string& file,
                         const std::vector<std::string>& requested,
                         const std::vector<Words>& others) {
  for (const Words& words : others) {
    const bool is_requested =
        words.column == "t" || std::ranges::any_of(requested, [&](const std::string& measure) {
          return has_name(measure, words.column);
        });
    if (!is_requested) continue;
    throw InputError(file + ": column " + shown(words.column) + ", row " +
                     std::to_string(words.row) + ": found " + bbsim::quoted(words.first) +
                     "; allowed: a number");
  }
  throw InputError(error);
}

// Warns of a log's columns whose values suggest units other than bbsim's.
void warn_of_units(const record::StoredRun& run, const std::vector<scenario::Measure>& measures,
                   const std::string& file, std::vector<std::string>& notes) {
  std::vector<const scenario::Column*> seen;
  for (const scenario::Measure& measure : measures) {
    for (const scenario::Column* column :
         {measure.column, measure.instant.column, measure.reference}) {
      if (column == nullptr || std::ranges::find(seen, column) != seen.end()) continue;
      seen.push_back(column);
      const double largest = scenario::largest_size(run.values_of(*column));
      const auto doubt = scenario::doubt_of(largest, column->name);
      if (!doubt) continue;
      notes.push_back("warning: " + file + ": " + std::string(column->name) + " goes up to " +
                      number_text(largest) + ", measured in " + std::string(column->unit) +
                      ": it looks like " + std::string(doubt->looks_like));
    }
  }
}

// Notes which value step metrics refer to if there is no reference.
void note_references(const record::StoredRun& run, const std::vector<scenario::Measure>& measures,
                     const std::string& file, std::vector<std::string>& notes) {
  std::vector<std::string> seen;
  for (const scenario::Measure& measure : measures) {
    const std::string lacking = run.lacks_reference(measure);
    if (lacking.empty() || std::ranges::find(seen, lacking) != seen.end()) continue;
    seen.push_back(lacking);
    notes.push_back("note: " + file + " has no column " + lacking + ": step metrics of " +
                    std::string(measure.column->name) + " refer to its own value at the end");
  }
}

}  // namespace

Measured measure(results::Result result, const std::string& file,
                 const std::vector<std::string>& lists) {
  const std::vector<std::string> requested = scenario::split_measures(lists);
  std::vector<Words> others;
  const bool is_log = result.version.empty();
  file::TableData numbers = numbers_of(std::move(result), others);
  try {
    const record::StoredRun run(std::move(numbers), file);
    const auto measures = run.measures_named(requested);
    Measured measured;
    std::vector<double> values;
    scenario::Whys whys;
    for (const scenario::Measure& measure : measures) {
      const record::Measured found = run.value_of(measure);
      measured.values.emplace_back(measure.name, found.value);
      values.push_back(found.value);
      whys.push_back(found.why);
    }
    if (is_log) warn_of_units(run, measures, file, measured.notes);
    note_references(run, measures, file, measured.notes);
    const std::string not_measured = scenario::why_not_finite(measures, values.data(), whys);
    if (!not_measured.empty()) measured.notes.push_back("note: " + not_measured);
    return measured;
  } catch (const InputError& error) {
    refuse(error, file, requested, others);
  }
}

namespace {

record::Allowances allowances_of(const CompareRequest& request, const file::CellTable& a,
                                 const file::CellTable& b) {
  const record::Allowance standard;
  if (request.rtol || request.atol) {
    return {request.rtol.value_or(standard.rtol), request.atol.value_or(standard.atol)};
  }
  return record::solver_allowances(a, b).value_or(standard);
}

// Warns of columns whose values suggest that the two files use different units.
void warn_of_units(const file::CellTable& table, const std::string& name,
                   const file::CellTable& other, const std::string& other_name,
                   std::vector<std::string>& warnings) {
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const file::CellColumn* const beside = other.find(table.names[c]);
    const std::vector<double>& numbers = table.columns[c].numbers;
    if (beside == nullptr || numbers.empty() || beside->numbers.empty()) continue;
    const auto warn = [&](const scenario::Doubt& doubt, const char* does, double value,
                          double other_value) {
      warnings.push_back("warning: " + name + ": " + shown(table.names[c]) + does +
                         number_text(value) + ", and in " + other_name + " " +
                         number_text(other_value) + ": it looks like " +
                         std::string(doubt.looks_like));
    };
    if (table.names[c] == "t") {
      const double span = numbers.back() - numbers.front();
      const double other_span = beside->numbers.back() - beside->numbers.front();
      if (!(other_span > 0)) continue;
      if (const auto doubt = scenario::doubt_of_span(span, other_span))
        warn(*doubt, " spans ", span, other_span);
      continue;
    }
    const double largest = scenario::largest_size(numbers);
    const double other_largest = scenario::largest_size(beside->numbers);
    const auto doubt = scenario::doubt_of(largest, table.names[c]);
    if (doubt && !scenario::doubt_of(other_largest, table.names[c])) {
      warn(*doubt, " goes up to ", largest, other_largest);
    }
  }
}

file::TableData numbers_of(results::Result result) {
  file::TableData table;
  for (results::Column& column : result.columns) {
    if (column.is_text()) continue;
    table.names.push_back(std::move(column.name));
    table.columns.push_back(std::move(column.numbers));
  }
  return table;
}

void warn_of_looks(const file::TableData& log, const std::string& name,
                   std::vector<std::string>& warnings) {
  for (std::size_t c = 0; c < log.names.size(); ++c) {
    const double largest = scenario::largest_size(log.columns[c]);
    const auto doubt = scenario::doubt_of(largest, log.names[c]);
    if (!doubt) continue;
    warnings.push_back("warning: " + name + ": " + shown(log.names[c]) + " goes up to " +
                       number_text(largest) + ", read in SI: it looks like " +
                       std::string(doubt->looks_like));
  }
}

// Runs the scenario with the log's columns and the rates that interpolation uses, at the output
// times and between them.
file::TableData run_for(const Scenario& scenario, const file::TableData& log, Watch& watch,
                        Compared& compared) {
  constexpr double near = 2e-3;  // s, between rows
  constexpr double most_rows = 2e5;
  RunRequest request;
  request.scenario = scenario;
  request.keeps_rows = true;
  OutputTimes& time = request.scenario.time;
  const double rows = time.end / time.step;
  time.step /= std::max(1.0, std::floor(std::min(std::ceil(time.step / near), most_rows / rows)));
  std::vector<std::string>& columns = request.scenario.output.columns;
  const auto has = [](const std::vector<std::string>& names, std::string_view name) {
    return std::ranges::find(names, name) != names.end();
  };
  for (const scenario::Column& column : scenario::catalogue) {
    constexpr std::array<std::string_view, 5> always{"t", "vx", "vy", "phi_rate", "theta_rate"};
    const bool wanted =
        has(log.names, column.name) || std::ranges::find(always, column.name) != always.end();
    if (!wanted || has(columns, column.name) || missing(column, scenario)) continue;
    columns.emplace_back(column.name);
  }
  RunResult result = run(request, watch);
  compared.code = result.code;
  compared.reason = result.summary.reason;
  compared.warnings.insert(compared.warnings.end(), result.summary.warnings.begin(),
                           result.summary.warnings.end());
  return std::move(result.rows);
}

file::TableData rows_of_result(const std::string& file) {
  results::Result result = results::read_result(file, {});
  if (result.is_sweep()) throw InputError(file + ": is a sweep; allowed: the result of a run");
  return numbers_of(std::move(result));
}

Compared compare_log(const CompareRequest& request, Watch& watch) {
  Compared compared;
  results::Result read = results::read_log(request.a, request.log, compared.warnings);
  if (const results::Column* const t = read.find("t"); t == nullptr || t->is_text()) {
    throw InputError(results::without_clock(read));
  }
  file::TableData log = numbers_of(std::move(read));
  const file::TableData run =
      request.run ? run_for(*request.run, log, watch, compared) : rows_of_result(request.b);
  if (compared.code == ExitCode::interrupted) return compared;
  if (request.log.aligns()) {
    const double offset = record::time_offset(log, request.a, run, request.b, request.columns);
    const auto t = std::ranges::find(log.names, "t") - log.names.begin();
    for (double& time : log.columns[static_cast<std::size_t>(t)]) time += offset;
    compared.warnings.push_back(moved_text(request.a, offset));
  }
  warn_of_looks(log, request.a, compared.warnings);
  const record::LogDistance distance =
      record::log_distance(log, request.a, run, request.b, request.columns);
  compared.text = record::to_text(distance, request.a, request.b);
  const bool judges = request.rtol || request.atol;
  compared.alike = true;
  for (const record::ColumnDistance& column : distance.columns) {
    const double larger = std::max(std::abs(column.log), std::abs(column.run));
    const double allowed = request.atol.value_or(0) + request.rtol.value_or(0) * larger;
    if (!judges || column.greatest <= allowed) continue;
    compared.alike = false;
    compared.text +=
        "different: " + shown(column.name) + " is more than " + number_text(allowed) + " apart\n";
  }
  return compared;
}

}  // namespace

std::string moved_text(const std::string& log, double offset) {
  char text[32];
  const int size = std::snprintf(text, sizeof text, "%.6g", offset);
  return "note: " + log + ": moved by " + std::string(text, static_cast<std::size_t>(size)) +
         " s (--time-offset auto)";
}

Compared compare(const CompareRequest& request, Watch& watch) {
  if (request.log.given() || request.run) return compare_log(request, watch);
  const file::CellTable a = file::read_cells(request.a, {request.columns, {}});
  const file::CellTable b = file::read_cells(request.b, {request.columns, {}});
  const record::Allowances allowances = allowances_of(request, a, b);
  const record::Comparison comparison = record::compare(a, b, allowances, request.columns);
  Compared compared;
  compared.alike = comparison.alike();
  compared.text = to_text(comparison, request.a, request.b, allowances);
  for (const file::CellTable* table : {&a, &b}) {
    compared.warnings.insert(compared.warnings.end(), table->notes.begin(), table->notes.end());
  }
  warn_of_units(a, request.a, b, request.b, compared.warnings);
  warn_of_units(b, request.b, a, request.a, compared.warnings);
  return compared;
}

std::string summarize(const SummarizeRequest& request) {
  const file::CellTable table = file::read_cells(request.file);
  const auto groups =
      record::summarise(table, request.file, request.keys,
                        scenario::split_measures(request.measures), request.quantiles);
  return record::to_csv(groups, request.keys, request.quantiles);
}

}  // namespace bbsim::api
