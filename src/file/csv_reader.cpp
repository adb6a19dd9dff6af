// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads CSV from bbsim, loggers, spreadsheets and other programs, for all commands.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <string_view>
#include <unordered_set>

#include "base/error.hpp"
#include "base/text.hpp"
#include "file/csv_fields.hpp"
#include "file/line_reader.hpp"
#include "file/table_writer.hpp"

namespace bbsim::file {
namespace {

constexpr std::array<char, 3> delimiters = {',', ';', '\t'};
constexpr std::size_t most_lines = 50;  // to search for a header

// The most bytes of numbers to keep from an endless input: half of this machine's memory.
std::size_t most_bytes() {
  const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
  if (pages <= 0 || page <= 0) return std::numeric_limits<std::size_t>::max();
  return static_cast<std::size_t>(pages) / 2 * static_cast<std::size_t>(page);
}

bool is_control(char c) {
  return static_cast<unsigned char>(c) < ' ' || c == '\x7f';
}

std::size_t numbers_in(const Fields& fields) {
  return static_cast<std::size_t>(std::ranges::count_if(fields.all(), is_number));
}

// How well a line fits as the header of the row below it with this delimiter: the count of numbers
// in the row; 0 if it cannot be its header.
std::size_t fit(std::string_view header, std::string_view row, char delimiter) {
  Fields names, fields;
  if (!names.take(header, delimiter) || !fields.take(row, delimiter)) return 0;
  const std::size_t count = names.size();
  if (fields.size() < count || (count == 1 && fields.size() > 1)) return 0;
  // A single column may hold decimal commas, but its header must not contain commas.
  if (count == 1 && delimiter != ',' && header.find(',') != std::string_view::npos) return 0;
  for (std::size_t c = 0; c < count; ++c) {
    const std::string_view name = names.all()[c];
    const bool may_be_empty = c == 0 || (c + 1 == count && fields.all()[c].empty());
    if (name.empty() ? !may_be_empty || count == 1 : is_number(name)) return 0;
    if (std::ranges::any_of(name, is_control)) return 0;
  }
  return numbers_in(fields);
}

struct Fit {
  std::size_t numbers = 0;
  char delimiter = ',';

  void offer(std::size_t more, char of) {
    if (more > numbers) *this = {more, of};
  }
};
Fit best_fit(std::string_view header, std::string_view row) {
  Fit best;
  for (const char delimiter : delimiters) best.offer(fit(header, row, delimiter), delimiter);
  return best;
}

class Parser {
 public:
  explicit Parser(const std::string& file) : lines_(file) {}

  Table parse(const CsvChoice& choice) {
    read_header(choice.header);
    // Guesses the number of rows, to avoid most reallocations.
    const std::size_t rows = lines_.size().value_or(0) / (2 * names_.size()) + 1;
    constexpr std::size_t most = 4096;
    for (const std::string& name : names_) {
      reads_.push_back(choice.wanted.empty() || name == "t" ||
                       std::ranges::find(choice.wanted, name) != choice.wanted.end());
      table_.columns.push_back({name, {}});
      table_.columns.back().numbers.reserve(std::min(rows, most));
    }
    // A file has no limit; this machine's memory limits an endless input.
    const std::size_t most_rows = lines_.size() ? std::numeric_limits<std::size_t>::max()
                                                : most_bytes() / (sizeof(double) * names_.size());
    while (next_row()) {
      if (table_.rows >= most_rows) {
        fail(1, "found more than " + std::to_string(most_rows) +
                    " rows, more than this machine's memory holds");
      }
      if (!read_row()) leave_out_cut_row();
    }
    note_rows();
    return std::move(table_);
  }

 private:
  struct Line {
    std::string text;
    std::size_t number = 0;
  };

  // Goes to the next line that is neither blank nor a remark: first in ahead_, then in the file.
  bool next_row() {
    if (next_ahead_ < ahead_.size()) {
      take(next_ahead_);
      return true;
    }
    while (const auto read = lines_.next()) {
      text_ = *read;
      number_ = lines_.number();
      const std::string_view line = trimmed(text_);
      if (!line.empty() && line.front() != '#') return true;
      if (!line.empty()) remark_ = {std::string(line.substr(1)), number_};
    }
    text_ = {};
    number_ = std::max<std::size_t>(lines_.number(), 1);
    return false;
  }

  // Looks ahead to the row with this index. Returns whether it exists.
  bool look(std::size_t index) {
    while (ahead_.size() <= index) {
      next_ahead_ = ahead_.size();
      if (!next_row()) return false;
      ahead_.push_back({std::string(text_), number_});
    }
    return true;
  }

  // Goes to a row of ahead_; next_row() continues after it.
  void take(std::size_t index) {
    text_ = ahead_[index].text;
    number_ = ahead_[index].number;
    next_ahead_ = index + 1;
  }

  void take_fields() {
    if (!fields_.take(text_, delimiter_)) {
      fail(1, "found a quotation mark without its closing one");
    }
  }

  void read_header(const std::vector<std::string>& given) {
    if (!look(0)) fail(1, "found no header; the first row names the columns");
    if (!given.empty()) return take_given(given);
    const Line remark = remark_;
    for (std::size_t i = 0; i < most_lines && look(i + 1); ++i) {
      if (take_labels(i)) return;
      const Fit found = best_fit(ahead_[i].text, ahead_[i + 1].text);
      if (found.numbers == 0) continue;
      delimiter_ = found.delimiter;
      Fields names, above;
      names.take(ahead_[i].text, delimiter_);
      // Lines just above with as many fields belong to the table. The first of them is the header.
      std::size_t header = i;
      while (header > 0 && names.size() > 1 && above.take(ahead_[header - 1].text, delimiter_) &&
             above.size() == names.size()) {
        --header;
      }
      note_lines_before("the header is line ", header);
      take(header);
      take_names();
      if (header + 1 == i && std::ranges::all_of(names.all(), is_unit)) {
        add_units(names.all());
        take(i);
      }
      return;
    }
    // A remark may name the columns, as from numpy.savetxt.
    if (remark.number != 0) {
      const Fit found = best_fit(remark.text, ahead_[0].text);
      if (found.numbers > 0) {
        delimiter_ = found.delimiter;
        text_ = remark.text;
        number_ = remark.number;
        next_ahead_ = 0;
        take_names();
        return;
      }
    }
    take(0);
    for (const char delimiter : {'\t', ';', ','}) {
      if (text_.find(delimiter) != std::string_view::npos) delimiter_ = delimiter;
    }
    take_names();
  }

  // Takes the names from the labels of this row and the next one, if both have the same. The row
  // itself stays to be read.
  bool take_labels(std::size_t row) {
    Fields below;
    if (!fields_.take_labelled(ahead_[row].text) || !below.take_labelled(ahead_[row + 1].text) ||
        fields_.labels() != below.labels()) {
      return false;
    }
    std::unordered_set<std::string_view> seen;
    for (const std::string_view label : fields_.labels()) {
      if (std::ranges::any_of(label, is_control) || !seen.emplace(label).second) return false;
    }
    names_.assign(fields_.labels().begin(), fields_.labels().end());
    labelled_ = true;
    next_ahead_ = row;
    note_lines_before("rows begin in line ", row);
    return true;
  }

  void add_units(const std::vector<std::string_view>& units) {
    for (std::size_t c = 0; c < names_.size(); ++c) {
      const std::string unit(units[c]);
      if (unit.empty() || unit == "-") continue;
      const bool brackets = unit.ends_with(']') || unit.ends_with(')');
      names_[c] += brackets ? ' ' + unit : " [" + unit + ']';
    }
  }

  // Uses the names that the user gave, and skips lines before the first row.
  void take_given(const std::vector<std::string>& given) {
    names_ = given;
    Fit best;
    std::size_t first = 0;
    for (; first < most_lines && look(first) && best.numbers == 0; ++first) {
      for (const char delimiter : delimiters) {
        if (fields_.take(ahead_[first].text, delimiter) && fields_.size() >= given.size()) {
          best.offer(numbers_in(fields_), delimiter);
        }
      }
    }
    delimiter_ = best.delimiter;
    next_ahead_ = best.numbers == 0 ? 0 : first - 1;
    note_lines_before("rows begin in line ", next_ahead_);
  }

  void take_names() {
    if (trimmed(text_).empty()) fail(1, "found no header; the first row names the columns");
    header_ = std::string(text_);
    take_fields();
    std::unordered_set<std::string_view> seen;
    for (std::size_t c = 0; c < fields_.size(); ++c) {
      const std::string_view name = fields_.all()[c];
      if (std::ranges::any_of(name, is_control)) {
        fail_at(c, "found a control character in the header; a CSV file is plain text");
      }
      double number = 0;
      if (read_number(name, number) != Reading::no_number) {
        // As Arduino's serial monitor writes it: "12:00:01.250 -> 1.2,3.4".
        const bool stamped = text_.find(" -> ") != std::string_view::npos;
        fail_at(c, "found the number " + quoted(name, longest_name) +
                       "; the first row names the columns, or --header NAME,... does" +
                       (stamped ? ", once a comma takes the place of \" -> \" in each line" : ""));
      }
      if (!name.empty() && !seen.emplace(name).second) {
        fail_at(c, "column " + quoted(name, longest_name) + " appears twice");
      }
      names_.emplace_back(name);
    }
    name_the_nameless();
  }

  // A first column without a name is the index from pandas. A last one is the empty text after a
  // delimiter at the end of each line.
  void name_the_nameless() {
    Fields row;
    const bool has_row =
        next_ahead_ < ahead_.size() && row.take(ahead_[next_ahead_].text, delimiter_);
    const std::size_t last = names_.size() - 1;
    for (std::size_t c = 0; c <= last; ++c) {
      if (!names_[c].empty()) continue;
      if (has_row && c == last && c > 0 && row.size() == last + 1 && row.all()[c].empty()) {
        names_.pop_back();
        return;
      }
      if (!has_row || c > 0 || c == last) fail_at(c, "a column's name is empty");
      names_[c] = std::ranges::count(names_, "index") > 0 ? "row index" : "index";
    }
  }

  // Returns false, without a row, if the line has too few fields.
  [[nodiscard]] bool read_row() {
    if (text_ == header_) {
      ++headers_again_;
      return true;
    }
    if (!labelled_) {
      take_fields();
    } else if (!fields_.take_labelled(text_) || !std::ranges::equal(fields_.labels(), names_)) {
      return false;
    }
    if (fields_.size() < names_.size()) return false;
    for (std::size_t c = 0; c < names_.size(); ++c) {
      if (reads_[c]) read(fields_.all()[c], c);
    }
    const auto beyond = fields_.all().begin() + static_cast<std::ptrdiff_t>(names_.size());
    if (!std::all_of(beyond, fields_.all().end(), std::mem_fn(&std::string_view::empty))) {
      take_beyond();
    }
    ++table_.rows;
    return true;
  }

  void read(std::string_view field, std::size_t c) {
    Column& column = table_.columns[c];
    double value = 0;
    switch (read_field(field, value)) {
      case Reading::number:
        column.numbers.push_back(value);
        if (!column.texts.empty()) column.texts.emplace_back();
        return;
      case Reading::no_number:
        if (is_gap(field)) return column.add_text("");
        if (column.first_text.line == 0) column.first_text = {number_, fields_.column(c)};
        return column.add_text(std::string(field));
      case Reading::too_large:
        fail_at(c, "column " + shown(names_[c]) + ": found " + quoted(field, longest_name) +
                       ", too large for a double (at most 1.8e308)");
    }
  }

  // A logger that is switched on or off within a row cuts the first or the last one. A board prints
  // lines of words between its rows. Refuses other rows with too few fields.
  void leave_out_cut_row() {
    const std::size_t number = number_;
    if (!labelled_ && numbers_in(fields_) == 0) {
      if (lines_of_words_++ == 0) first_words_ = number;
      return;
    }
    const std::string found = count_text();
    const bool first = table_.rows == 0 && !cut_first_;
    cut_first_ = cut_first_ || first;
    const bool more = next_row();
    if (first ? !more : more || table_.rows == 0) {
      number_ = number;
      fail(1, found + "; complete the row, or remove it");
    }
    note("warning", number,
         found + "; the " + (first ? "first" : "last") + " row is cut, and left out");
    if (first && !read_row()) leave_out_cut_row();
  }

  [[nodiscard]] std::string count_text() const {
    if (labelled_) {
      return "found " + quoted(text_, longest_name) + "; the first row has " +
             counted(names_.size(), "label") + ", " + joined(names_);
    }
    const bool numbers = numbers_in(fields_) == fields_.size();
    return "found " + counted(fields_.size(), numbers ? "number" : "field") +
           "; the header names " + counted(names_.size(), "column");
  }

  void take_beyond() {
    // With decimal points, commas do not mark decimals.
    const auto has_point = [](std::string_view field) {
      return field.find('.') != std::string_view::npos && is_number(field);
    };
    if (delimiter_ == ',' && std::ranges::none_of(fields_.all(), has_point)) ++rows_split_;
    if (rows_beyond_++ == 0) first_beyond_ = {count_text(), number_};
  }

  void note(const std::string& kind, std::size_t line, const std::string& what) {
    const std::string place = line == 0 ? "" : ':' + std::to_string(line);
    table_.notes.push_back(kind + ": " + lines_.name() + place + ": " + what);
  }

  void note_lines_before(const char* begins, std::size_t row) {
    if (row == 0) return;
    note("note", 0,
         begins + std::to_string(ahead_[row].number) + "; the lines before it are left out");
  }

  void note_rows() {
    const auto more = [](std::size_t rows) {
      return rows == 1 ? "" : ", here and in " + counted(rows - 1, "more row");
    };
    if (2 * rows_split_ > table_.rows) {
      number_ = first_beyond_.number;
      fail(1, first_beyond_.text +
                  "; name the others; or, if commas mark decimals, separate the columns by "
                  "semicolons or tabs");
    }
    if (rows_beyond_ > 0) {
      note("warning", first_beyond_.number,
           first_beyond_.text + "; the fields beyond are left out" + more(rows_beyond_));
    }
    if (lines_of_words_ > 0) {
      note("warning", first_words_,
           "found words between the rows; left out" + more(lines_of_words_));
    }
    if (headers_again_ > 0) {
      note("note", 0, "the header is repeated in " + counted(headers_again_, "row") + ", left out");
    }
  }

  // At a column of the current line, from 1.
  [[noreturn]] void fail(std::size_t column, const std::string& message) const {
    throw InputError({Problem{
        lines_.name() + ':' + std::to_string(number_) + ':' + std::to_string(column), message}});
  }
  [[noreturn]] void fail_at(std::size_t field, const std::string& message) const {
    fail(fields_.column(field), message);
  }

  LineReader lines_;
  std::string_view text_;    // the current line without its end
  std::size_t number_ = 1;   // number of the current line
  std::vector<Line> ahead_;  // rows read in search of the header
  std::size_t next_ahead_ = 0;
  Line remark_{};  // the last remark
  char delimiter_ = ',';
  bool labelled_ = false;  // each field has its column's name before it
  std::string header_;
  std::vector<std::string> names_;
  Table table_;
  std::vector<bool> reads_;  // per column: whether to read it
  Fields fields_;            // of the current line
  bool cut_first_ = false;   // the first row had too few fields
  Line first_beyond_{};      // the first row with fields beyond the columns
  std::size_t rows_beyond_ = 0, headers_again_ = 0;
  std::size_t rows_split_ = 0;  // of these, rows in which commas may mark decimals
  std::size_t lines_of_words_ = 0, first_words_ = 0;
};

}  // namespace

Table read_csv(const std::string& file, const CsvChoice& choice) {
  return Parser(file).parse(choice);
}

}  // namespace bbsim::file
