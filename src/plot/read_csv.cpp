// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// CSV of any origin: numbers and texts, quoted or not, as a picture can use them.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string_view>
#include <unordered_set>

#include "base/error.hpp"
#include "base/number_text.hpp"
#include "base/shown.hpp"
#include "base/text.hpp"
#include "file/case_text.hpp"
#include "file/line_reader.hpp"
#include "plot/read_result.hpp"
#include "scenario/columns.hpp"

namespace bbsim::plot {
namespace {

[[noreturn]] void fail(const file::LineReader& lines, const std::string& message) {
  throw InputError({Problem{lines.name() + ":" + std::to_string(lines.number()), message}});
}
[[noreturn]] void fail_whole(const file::LineReader& lines, const std::string& message) {
  throw InputError(lines.name() + ": " + message);
}

bool is_number(std::string_view text, double& value) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (stop != text.data() + text.size() || text.empty()) return false;
  if (error == std::errc::result_out_of_range) value = std::numeric_limits<double>::quiet_NaN();
  return error != std::errc::invalid_argument;
}

// The fields of one line, as views into it, or into `unquoted` where something is quoted.
class Fields {
 public:
  bool split(std::string_view line) {
    views_.clear();
    if (line.find('"') != std::string_view::npos) {
      if (!file::split_fields(line, unquoted_)) return false;
      for (const std::string& field : unquoted_) views_.push_back(trimmed(field));
      return true;
    }
    for (std::size_t start = 0; start != std::string_view::npos;) {
      const std::size_t comma = line.find(',', start);
      views_.push_back(trimmed(line.substr(start, comma - start)));
      start = comma == std::string_view::npos ? comma : comma + 1;
    }
    return true;
  }
  [[nodiscard]] const std::vector<std::string_view>& views() const { return views_; }

 private:
  std::vector<std::string_view> views_;
  std::vector<std::string> unquoted_;
};

void read_header(const file::LineReader& lines, const Fields& fields, Result& result) {
  double ignored = 0;
  const auto& names = fields.views();
  if (std::ranges::all_of(names, [&](std::string_view n) { return is_number(n, ignored); })) {
    fail(lines, "is a row of numbers; the first line names the columns");
  }
  std::unordered_set<std::string_view> seen;
  for (const std::string_view name : names) {
    if (name.empty()) fail(lines, "a column's name is empty");
    if (!seen.insert(name).second) {
      fail(lines, "the column " + shown(name) + " is there twice");
    }
    result.columns.push_back({std::string(name), {}});
  }
}

// Whether a table is one that bbsim writes: all of its columns are in `bbsim columns`, some of them
// under names that are nobody else's, and its numbers have the digits of doubles, as those of a
// rig's log have not.
bool looks_like_a_run(const Result& table, std::size_t longest_number) {
  constexpr std::size_t digits_of_doubles = 15;
  constexpr std::array<std::string_view, 12> anybodys = {
      "t", "x", "y", "vx", "vy", "phi", "theta", "spin", "tilt", "distance", "power", "energy"};
  if (longest_number < digits_of_doubles || table.find("t") == nullptr) return false;
  bool own_name = false;
  for (const Column& column : table.columns) {
    if (scenario::find_column(column.name) == nullptr) return false;
    own_name = own_name || std::ranges::find(anybodys, column.name) == anybodys.end();
  }
  return own_name;
}

void add_field(Column& column, std::string_view field) {
  double value = std::numeric_limits<double>::quiet_NaN();
  const bool number = field.empty() || is_number(field, value);
  if (!number && !column.is_text()) {  // the first one: what came before is text from now on
    for (const double before : column.numbers) {
      column.texts.push_back(std::isnan(before) ? "" : number_text(before));
    }
    column.texts.emplace_back(field);
  } else if (column.is_text()) {
    column.texts.emplace_back(field);
  }
  column.numbers.push_back(value);
}

}  // namespace

Result read_csv_columns(const std::string& file) {
  file::LineReader lines(file);
  Result result;
  result.file = file;
  Fields fields;
  std::optional<std::string_view> next = lines.next();
  if (!next) fail_whole(lines, "is empty; a header with the columns' names is expected");
  std::string_view line = *next;
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (line.starts_with(byte_order_mark)) line.remove_prefix(byte_order_mark.size());
  if (line.find('\0') != std::string_view::npos || !fields.split(line)) {
    fail(lines, "is no header of a CSV file");
  }
  read_header(lines, fields, result);
  std::size_t longest_number = 0;
  while ((next = lines.next())) {
    line = *next;
    if (trimmed(line).empty()) continue;
    if (!fields.split(line)) fail(lines, "a quote is left open");
    if (fields.views().size() != result.columns.size()) {
      fail(lines, "found " + std::to_string(fields.views().size()) + " fields; the header names " +
                      std::to_string(result.columns.size()) + " columns");
    }
    for (std::size_t c = 0; c < result.columns.size(); ++c) {
      add_field(result.columns[c], fields.views()[c]);
      longest_number = std::max(longest_number, fields.views()[c].size());
    }
    ++result.rows;
  }
  if (result.rows == 0) fail_whole(lines, "has a header and no rows");
  result.units_known = result.is_sweep() || looks_like_a_run(result, longest_number);
  return result;
}

}  // namespace bbsim::plot
