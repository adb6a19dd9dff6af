// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/measure.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>

#include "base/error.hpp"
#include "base/number_text.hpp"
#include "base/quoted.hpp"
#include "file/table_writer.hpp"
#include "record/measure_rows.hpp"
#include "scenario/unit_doubts.hpp"

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

}  // namespace bbsim::api
