// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/measure.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <string_view>

#include "api/run.hpp"
#include "base/number_text.hpp"
#include "base/text.hpp"
#include "file/table.hpp"
#include "record/compare.hpp"
#include "record/log_distance.hpp"
#include "record/stored_run.hpp"
#include "record/summarise.hpp"
#include "scenario/columns.hpp"
#include "scenario/log_columns.hpp"
#include "scenario/measures.hpp"

namespace bbsim::api {
namespace {

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

// Throws a message about the first text in `t` or a requested column, else `error`.
[[noreturn]] void refuse(const InputError& error, const std::string& file,
                         const std::vector<std::string>& requested,
                         const std::vector<file::Column>& texts) {
  for (const file::Column& column : texts) {
    const bool is_requested =
        column.name == "t" || std::ranges::any_of(requested, [&](const std::string& measure) {
          return has_name(measure, column.name);
        });
    if (is_requested) file::refuse_text(file, column);
  }
  throw InputError(error);
}

// Warns of a log's column whose values suggest units other than bbsim's.
void warn_of_looks(const std::string& file, std::string_view column,
                   const std::vector<double>& numbers, std::string_view read,
                   std::vector<std::string>& notes) {
  const double largest = scenario::largest_size(numbers);
  const auto doubt = scenario::doubt_of(largest, column);
  if (!doubt) return;
  notes.push_back("warning: " + file + ": " + shown(column) + " goes up to " +
                  number_text(largest) + ", " + std::string(read) + ": it looks like " +
                  std::string(doubt->looks_like));
}

// The same for the columns of measures.
void warn_of_units(const record::StoredRun& run, const std::vector<scenario::Measure>& measures,
                   const std::string& file, std::vector<std::string>& notes) {
  std::vector<const scenario::Column*> seen;
  for (const scenario::Measure& measure : measures) {
    for (const scenario::Column* column :
         {measure.column, measure.instant.column, measure.reference}) {
      if (column == nullptr || std::ranges::find(seen, column) != seen.end()) continue;
      seen.push_back(column);
      warn_of_looks(file, column->name, run.values_of(*column),
                    "measured in " + std::string(column->unit), notes);
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

record::Allowances allowances_of(const CompareRequest& request, const file::Table& a,
                                 const file::Table& b) {
  const record::Allowance standard;
  if (request.rtol || request.atol) {
    return {request.rtol.value_or(standard.rtol), request.atol.value_or(standard.atol)};
  }
  return record::solver_allowances(a, b).value_or(standard);
}

// Warns of columns whose values suggest that the two files use different units.
void warn_of_units(const file::Table& table, const file::Table& other,
                   std::vector<std::string>& warnings) {
  for (const file::Column& column : table.columns) {
    const std::string& name = column.name;
    const std::vector<double>& numbers = column.numbers;
    const file::Column* const beside = other.find(name);
    if (beside == nullptr || numbers.empty() || beside->numbers.empty()) continue;
    const auto warn = [&](const scenario::Doubt& doubt, const char* does, double value,
                          double other_value) {
      warnings.push_back("warning: " + table.file + ": " + shown(name) + does + number_text(value) +
                         ", and in " + other.file + " " + number_text(other_value) +
                         ": it looks like " + std::string(doubt.looks_like));
    };
    if (name == "t") {
      const double span = numbers.back() - numbers.front();
      const double other_span = beside->numbers.back() - beside->numbers.front();
      if (!(other_span > 0)) continue;
      if (const auto doubt = scenario::doubt_of_span(span, other_span))
        warn(*doubt, " spans ", span, other_span);
      continue;
    }
    const double largest = scenario::largest_size(numbers);
    const double other_largest = scenario::largest_size(beside->numbers);
    constexpr double least_factor = 10;  // between two units: 57 or more
    const auto doubt = scenario::doubt_of(largest, name);
    if (doubt && largest > least_factor * other_largest) {
      warn(*doubt, " goes up to ", largest, other_largest);
    }
  }
}

// Runs the scenario with the log's columns and the rates that interpolation uses, at the output
// times and between them.
file::Table run_for(const Scenario& scenario, const file::Table& log, Watch& watch,
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
  for (const scenario::Column& column : scenario::catalogue) {
    constexpr std::array<std::string_view, 5> always{"t", "vx", "vy", "phi_rate", "theta_rate"};
    const bool wanted =
        log.find(column.name) != nullptr || std::ranges::find(always, column.name) != always.end();
    const bool is_there = std::ranges::find(columns, column.name) != columns.end();
    if (!wanted || is_there || missing(column, scenario)) continue;
    columns.emplace_back(column.name);
  }
  RunResult result = run(request, watch);
  compared.code = result.code;
  compared.reason = result.summary.reason;
  compared.warnings.insert(compared.warnings.end(), result.summary.warnings.begin(),
                           result.summary.warnings.end());
  return std::move(result.rows);
}

file::Table rows_of_result(const std::string& file) {
  results::Result result = results::read_result(file, {});
  if (result.is_sweep()) throw InputError(file + ": is a sweep; allowed: the result of a run");
  return result;
}

Compared compare_log(const CompareRequest& request, Watch& watch) {
  Compared compared;
  results::Result log = results::read_log(request.a, request.log);
  const file::Column* const t = log.find("t");
  if (t == nullptr || t->is_text()) throw InputError(results::without_clock(log));
  compared.warnings = log.notes;
  log.take_texts();
  file::Table run =
      request.run ? run_for(*request.run, log, watch, compared) : rows_of_result(request.b);
  run.file = request.b;
  run.take_texts();
  if (compared.code == ExitCode::interrupted) return compared;
  if (request.log.aligns()) {
    const double offset = record::time_offset(log, run, request.columns);
    for (double& time : log.find("t")->numbers) time += offset;
    compared.warnings.push_back(moved_text(request.a, offset));
  }
  for (const file::Column& column : log.columns) {
    warn_of_looks(log.file, column.name, column.numbers, "read in SI", compared.warnings);
  }
  const record::LogDistance distance = record::log_distance(log, run, request.columns);
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

// How to compare a table with a run at its own times; empty if it has bbsim's columns.
std::string log_note(const file::Table& table, const file::Table& run) {
  const auto lacks = [&](const char* name) {
    return table.find(name) == nullptr && run.find(name) != nullptr;
  };
  const bool is_log = std::ranges::any_of(table.columns, [](const file::Column& column) {
    return scenario::find_column(column.name) == nullptr;
  });
  if (!is_log || !(lacks("t") || (lacks("x") && lacks("y")))) return "";
  return "note: if " + table.file + " is a log, --time-offset 0 or --map reads it as one";
}

}  // namespace

Measured measure(results::Result result, const std::string& file,
                 const std::vector<std::string>& lists) {
  const std::vector<std::string> requested = scenario::split_measures(lists);
  if (result.is_sweep()) {
    throw InputError(result.file +
                     ": is a sweep; allowed: the result of a run. Measures of a sweep "
                     "are its columns: bbsim summarize " +
                     result.file);
  }
  const bool is_log = result.version.empty();
  const std::vector<file::Column> texts = result.take_texts();
  try {
    const record::StoredRun run(std::move(result), file);
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
    refuse(error, file, requested, texts);
  }
}

std::string moved_text(const std::string& log, double offset) {
  return "note: " + log + ": moved by " + short_number(offset) + " s (--time-offset auto)";
}

Compared compare(const CompareRequest& request, Watch& watch) {
  if (request.log.given() || request.run) return compare_log(request, watch);
  const file::Table a = file::read_table(request.a, {request.columns, {}});
  const file::Table b = file::read_table(request.b, {request.columns, {}});
  const record::Allowances allowances = allowances_of(request, a, b);
  const record::Comparison comparison = record::compare(a, b, allowances, request.columns);
  Compared compared;
  compared.alike = comparison.alike();
  compared.text = to_text(comparison, request.a, request.b, allowances);
  for (const file::Table* table : {&a, &b}) {
    compared.warnings.insert(compared.warnings.end(), table->notes.begin(), table->notes.end());
  }
  if (const std::string note = log_note(a, b); !note.empty()) compared.warnings.push_back(note);
  warn_of_units(a, b, compared.warnings);
  warn_of_units(b, a, compared.warnings);
  return compared;
}

std::string summarize(const SummarizeRequest& request) {
  const file::Table table = file::read_table(request.file);
  return record::summarise(table, request.file, request.keys,
                           scenario::split_measures(request.measures), request.quantiles);
}

}  // namespace bbsim::api
