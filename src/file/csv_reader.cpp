// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads CSV strictly: a header of bare names, then rows with one number (or one text, if allowed)
// for each column.
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>
#include <string_view>
#include <unordered_set>

#include "base/error.hpp"
#include "base/shown.hpp"
#include "base/text.hpp"
#include "file/case_text.hpp"
#include "file/formats.hpp"
#include "file/line_reader.hpp"

namespace bbsim::file {
namespace {

// The most bytes of numbers to keep from an endless input: half of this machine's memory.
std::size_t most_bytes() {
  const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
  if (pages <= 0 || page <= 0) return std::numeric_limits<std::size_t>::max();
  return static_cast<std::size_t>(pages) / 2 * static_cast<std::size_t>(page);
}

bool is_control(char c) {
  return static_cast<unsigned char>(c) < ' ' || c == '\x7f';
}

constexpr std::size_t longest_name = 40;  // in messages

std::string what_was_found(std::string_view text) {
  return "found " + quoted(text, longest_name);
}

// Reads the whole text as a number, rounded to the nearest double.
enum class Reading { number, no_number, too_large };
Reading read_number(std::string_view text, double& value) {
  // std::from_chars refuses a plus sign.
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error == std::errc::invalid_argument || stop != end) return Reading::no_number;
  if (error == std::errc::result_out_of_range) {  // also for tiny numbers that round to 0
    value = std::strtod(std::string(text).c_str(), nullptr);
    if (std::isinf(value)) return Reading::too_large;
  }
  return Reading::number;
}

class Parser {
 public:
  explicit Parser(const std::string& file) : lines_(file) {}

  TableData parse() {
    read_header();
    const std::size_t columns = table_.names.size();
    table_.columns.resize(columns);
    // A guess of the number of rows that avoids most reallocations.
    const std::size_t rows = lines_.size().value_or(0) / (2 * columns) + 1;
    constexpr std::size_t most = 4096;
    for (auto& column : table_.columns) column.reserve(std::min(rows, most));
    const std::size_t most_rows = room_for_rows();
    while (next_line()) {
      require_room(table_.columns[0].size(), most_rows);
      read_row();
    }
    return std::move(table_);
  }

  CellTable parse_cells(const std::vector<std::string>& wanted) {
    read_header();
    CellTable cells;
    cells.names = table_.names;
    cells.columns.resize(cells.names.size());
    std::vector<bool> reads;
    for (const std::string& name : cells.names) {
      reads.push_back(wanted.empty() || name == "t" ||
                      std::find(wanted.begin(), wanted.end(), name) != wanted.end());
    }
    const std::size_t most_rows = room_for_rows();
    for (; next_line(); ++cells.rows) {
      require_room(cells.rows, most_rows);
      read_cells(reads, cells);
    }
    return cells;
  }

 private:
  // A file may have any number of rows. An endless input is limited by this machine's memory.
  [[nodiscard]] std::size_t room_for_rows() const {
    return lines_.size() ? std::numeric_limits<std::size_t>::max()
                         : most_bytes() / (sizeof(double) * table_.names.size());
  }

  void require_room(std::size_t rows, std::size_t most) const {
    if (rows < most) return;
    fail(text_, "found more than " + std::to_string(most) +
                    " rows; that is more than this machine has memory for");
  }

  bool next_line() {
    const std::optional<std::string_view> line = lines_.next();
    text_ = line.value_or(std::string_view());
    return line.has_value();
  }

  // Calls use(field, index) for each field of the line. Returns the number of fields.
  template <class Use>
  std::size_t for_each_field(Use use) const {
    std::size_t count = 0;
    for (std::size_t start = 0;;) {
      const std::size_t comma = text_.find(',', start);
      use(trimmed(text_.substr(start, comma - start)), count++);  // npos - start reaches to the end
      if (comma == std::string_view::npos) return count;
      start = comma + 1;
    }
  }

  void read_header() {
    next_line();
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (text_.starts_with(byte_order_mark)) text_.remove_prefix(byte_order_mark.size());
    if (trimmed(text_).empty()) fail(text_, "found no header; the first row names the columns");
    std::unordered_set<std::string_view> seen;
    for_each_field([&](std::string_view name, std::size_t) {
      double number = 0;
      if (name.empty()) fail(name, "a column's name is empty");
      if (name.find(';') != std::string_view::npos || name.find('\t') != std::string_view::npos) {
        fail(name, what_was_found(name) + "; commas separate columns");
      }
      if (std::any_of(name.begin(), name.end(), is_control)) {
        fail(name, "found a control character in the header; a CSV file is plain text");
      }
      if (name.find('"') != std::string_view::npos) {
        fail(name, what_was_found(name) + "; names stand without quotation marks");
      }
      if (read_number(name, number) != Reading::no_number) {
        fail(name, "found the number " + quoted(name, longest_name) +
                       "; the first row names the columns");
      }
      if (!seen.insert(name).second) {
        fail(name, "column " + quoted(name, longest_name) + " is there twice");
      }
      table_.names.emplace_back(name);
    });
  }

  // Reads a row of numbers and text, only in the columns that `reads` selects.
  void read_cells(const std::vector<bool>& reads, CellTable& cells) {
    if (trimmed(text_).empty()) fail(text_, "found a blank line; each line is a row");
    const auto read = [&](std::string_view field, std::size_t c) {
      if (c >= reads.size() || !reads[c]) return;
      double value = 0;
      switch (read_number(field, value)) {
        case Reading::number:
          return cells.columns[c].add_number(value);
        case Reading::no_number:
          return cells.columns[c].add_text(std::string(field));
        case Reading::too_large:
          fail(text_, "column " + table_.names[c] + ": " + what_was_found(field) +
                          ", too large for a double (at most 1.8e308)");
      }
    };
    std::size_t found = 0;
    if (text_.find('"') == std::string_view::npos) {
      found = for_each_field(read);
    } else {
      if (!split_fields(text_, fields_))
        fail(text_, "found a quotation mark without its closing one");
      for (const std::string& field : fields_) read(trimmed(field), found++);
    }
    require_fields(found, found == 1 ? " field" : " fields");
  }

  void require_fields(std::size_t found, const char* what) const {
    const std::size_t expected = table_.names.size();
    if (found == expected) return;
    fail(text_, "found " + std::to_string(found) + what + "; the header names " +
                    std::to_string(expected) + (expected == 1 ? " column" : " columns"));
  }

  void read_row() {
    const std::size_t expected = table_.names.size();
    const std::size_t found = for_each_field([&](std::string_view field, std::size_t c) {
      if (c >= expected) return;
      double value = 0;
      const Reading reading = read_number(field, value);
      if (reading == Reading::number) {
        table_.columns[c].push_back(value);
        return;
      }
      if (trimmed(text_).empty()) fail(field, "found a blank line; each line is a row of numbers");
      fail(field, "column " + shown(table_.names[c]) + ": " + what_was_found(field) +
                      (reading == Reading::too_large ? ", too large for a double (at most 1.8e308)"
                                                     : ", a number is expected"));
    });
    require_fields(found, found == 1 ? " number" : " numbers");
  }

  // `at` is a part of the line; the message gives its column.
  [[noreturn]] void fail(std::string_view at, const std::string& message) const {
    const auto column = at.data() == nullptr ? 0 : at.data() - text_.data();
    const std::size_t line = std::max<std::size_t>(lines_.number(), 1);
    throw InputError({Problem{
        lines_.name() + ":" + std::to_string(line) + ":" + std::to_string(column + 1), message}});
  }

  LineReader lines_;
  std::string_view text_;  // the current line without its end
  TableData table_;
  std::vector<std::string> fields_;  // of a line with quotation marks
};

}  // namespace

TableData read_csv(const std::string& file) {
  return Parser(file).parse();
}

CellTable read_csv_cells(const std::string& file, const std::vector<std::string>& wanted) {
  return Parser(file).parse_cells(wanted);
}

}  // namespace bbsim::file
