// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads CSV from bbsim, loggers, spreadsheets and other programs, for all commands.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <optional>
#include <string_view>
#include <unordered_set>

#include "base/error.hpp"
#include "base/quoted.hpp"
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

// Reads the whole text as a number, rounded to the nearest double.
enum class Reading { number, no_number, too_large };
Reading read_number(std::string_view text, double& value) {
  // std::from_chars() refuses a plus sign.
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

// Whether the field is one of the words that loggers write for a missing value.
bool is_gap(std::string_view field) {
  constexpr std::array<std::string_view, 6> words = {"NA", "N/A", "#N/A", "null", "NULL", "None"};
  return std::ranges::find(words, field) != words.end();
}

// Also reads a decimal comma that is not a delimiter.
Reading read_field(std::string_view field, double& value) {
  const Reading reading = read_number(field, value);
  const std::size_t comma = field.find(',');
  if (reading != Reading::no_number || comma == std::string_view::npos ||
      field.find('.') != std::string_view::npos) {
    return reading;
  }
  std::string text(field);
  text[comma] = '.';
  return read_number(text, value);
}

bool is_number(std::string_view field) {
  double ignored = 0;
  return read_field(field, ignored) != Reading::no_number;
}

// Whether a field may be a unit. Some loggers write units below the names, in a second line.
bool is_unit(std::string_view field) {
  constexpr std::array<std::string_view, 16> units = {"",      "-",   "s",   "ms", "us",  "m",
                                                      "cm",    "mm",  "deg", "°",  "rad", "deg/s",
                                                      "rad/s", "m/s", "V",   "A"};
  if (std::ranges::find(units, field) != units.end()) return true;
  return (field.starts_with('[') && field.ends_with(']')) ||
         (field.starts_with('(') && field.ends_with(')'));
}

// The fields of a line without blanks around them: parts of the line, or of `unquoted` if the line
// has quotation marks.
class Fields {
 public:
  // Returns false if a quote stays open.
  bool take(std::string_view line, char delimiter) {
    all_.clear();
    if (line.find('"') != std::string_view::npos) {
      if (!split_fields(line, unquoted_, delimiter)) return false;
      for (const std::string& field : unquoted_) all_.push_back(trimmed(field));
      return true;
    }
    for (std::size_t start = 0;;) {
      const std::size_t end = line.find(delimiter, start);
      all_.push_back(trimmed(line.substr(start, end - start)));  // for npos: to the end
      if (end == std::string_view::npos) return true;
      start = end + 1;
    }
  }
  [[nodiscard]] const std::vector<std::string_view>& all() const { return all_; }

 private:
  std::vector<std::string_view> all_;
  std::vector<std::string> unquoted_;
};

// The same as texts; nothing if a quote stays open.
std::optional<std::vector<std::string>> fields_of(std::string_view line, char delimiter) {
  Fields fields;
  if (!fields.take(line, delimiter)) return {};
  return std::vector<std::string>(fields.all().begin(), fields.all().end());
}

// How well a line fits as the header of the row below it with this delimiter: the count of numbers
// in the row; 0 if it cannot be its header.
std::size_t fit(std::string_view header, std::string_view row, char delimiter) {
  const auto names = fields_of(header, delimiter), fields = fields_of(row, delimiter);
  if (!names || !fields || fields->size() < names->size()) return 0;
  if (names->size() == 1 && fields->size() > 1) return 0;
  // A single column may hold decimal commas, but its header must not contain commas.
  if (names->size() == 1 && delimiter != ',' && header.find(',') != std::string_view::npos)
    return 0;
  for (std::size_t c = 0; c < names->size(); ++c) {
    const std::string& name = (*names)[c];
    const bool may_be_empty = c == 0 || (c + 1 == names->size() && (*fields)[c].empty());
    if (name.empty() ? !may_be_empty || names->size() == 1 : is_number(name)) return 0;
    if (std::ranges::any_of(name, is_control)) return 0;
  }
  return static_cast<std::size_t>(std::ranges::count_if(*fields, is_number));
}

// A field of a line such as "x:0.01 y:0.02 t:120", which the Arduino's serial plotter shows.
struct Labelled {
  std::string_view label, value;
};

// The fields of such a line, between blanks, tabs, commas or semicolons; empty for any other line.
// A label begins with a letter, so that a time of day is none.
std::vector<Labelled> labelled_fields(std::string_view line) {
  constexpr std::string_view between = " \t,;";
  std::vector<Labelled> fields;
  for (line = trimmed(line); !line.empty();) {
    const std::size_t colon = line.find(':');
    const std::string_view label = line.substr(0, colon);
    const unsigned char first = label.empty() ? '0' : static_cast<unsigned char>(label[0]);
    if (colon == std::string_view::npos || std::isalpha(first) == 0 ||
        label.find_first_of(between) != std::string_view::npos) {
      return {};
    }
    line.remove_prefix(colon + 1);
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    const std::string_view value = line.substr(0, line.find_first_of(between));
    if (!is_number(value) && !is_gap(value)) return {};
    fields.push_back({label, value});
    line.remove_prefix(value.size());
    line.remove_prefix(std::min(line.find_first_not_of(between), line.size()));
  }
  return fields;
}

bool have_same_labels(const std::vector<Labelled>& a, const std::vector<Labelled>& b) {
  return std::ranges::equal(a, b, {}, &Labelled::label, &Labelled::label);
}

struct Fit {
  std::size_t numbers = 0;
  char delimiter = ',';
};
Fit best_fit(std::string_view header, std::string_view row) {
  Fit best;
  for (const char delimiter : {',', ';', '\t'}) {
    const std::size_t numbers = fit(header, row, delimiter);
    if (numbers > best.numbers) best = {numbers, delimiter};
  }
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
    const std::size_t most_rows = room_for_rows();
    while (next_row()) {
      require_room(table_.rows, most_rows);
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

  // The most rows to read. A file has no limit; this machine's memory limits an endless input.
  [[nodiscard]] std::size_t room_for_rows() const {
    return lines_.size() ? std::numeric_limits<std::size_t>::max()
                         : most_bytes() / (sizeof(double) * names_.size());
  }

  void require_room(std::size_t rows, std::size_t most) const {
    if (rows < most) return;
    fail(text_, "found more than " + std::to_string(most) +
                    " rows, more than this machine's memory holds");
  }

  bool next_line() {
    const std::optional<std::string_view> line = lines_.next();
    text_ = line.value_or(std::string_view());
    number_ = std::max<std::size_t>(lines_.number(), 1);
    return line.has_value();
  }

  // Goes to the next line that is neither blank nor a remark: first in ahead_, then in the file.
  bool next_row() {
    if (next_ahead_ < ahead_.size()) {
      text_ = ahead_[next_ahead_].text;
      number_ = ahead_[next_ahead_++].number;
      return true;
    }
    while (next_line()) {
      const std::string_view line = trimmed(text_);
      if (!line.empty() && line.front() != '#') return true;
      if (!line.empty()) remark_ = {std::string(line.substr(1)), number_};
    }
    return false;
  }

  // Looks ahead to the row with this index. Returns whether it exists.
  bool look(std::size_t index) {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    while (ahead_.size() <= index) {
      next_ahead_ = ahead_.size();
      if (!next_row()) return false;
      if (number_ == 1 && text_.starts_with(byte_order_mark)) {
        text_.remove_prefix(byte_order_mark.size());
        const std::string_view line = trimmed(text_);
        if (line.starts_with('#')) remark_ = {std::string(line.substr(1)), number_};
        if (line.empty() || line.starts_with('#')) continue;
      }
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

  void read_header(const std::vector<std::string>& given) {
    if (!look(0)) {
      text_ = {};
      fail(text_, "found no header; the first row names the columns");
    }
    if (!given.empty()) return take_given(given);
    const Line remark = remark_;
    constexpr std::size_t most_lines = 50;
    for (std::size_t i = 0; i < most_lines && look(i + 1); ++i) {
      if (take_labels(i)) return;
      const Fit found = best_fit(ahead_[i].text, ahead_[i + 1].text);
      if (found.numbers == 0) continue;
      delimiter_ = found.delimiter;
      const auto names = fields_of(ahead_[i].text, delimiter_);
      // Lines just above with as many fields belong to the table. The first of them is the header.
      std::size_t header = i;
      while (header > 0 && names->size() > 1) {
        const auto above = fields_of(ahead_[header - 1].text, delimiter_);
        if (!above || above->size() != names->size()) break;
        --header;
      }
      note_lines_before("the header is line ", header);
      take(header);
      take_names();
      if (header + 1 == i && std::ranges::all_of(*names, is_unit)) {
        add_units(*names);
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
    const std::vector<Labelled> fields = labelled_fields(ahead_[row].text);
    if (fields.empty() || !have_same_labels(fields, labelled_fields(ahead_[row + 1].text))) {
      return false;
    }
    std::unordered_set<std::string_view> seen;
    for (const Labelled& field : fields) {
      if (std::ranges::any_of(field.label, is_control) || !seen.emplace(field.label).second) {
        return false;
      }
      names_.emplace_back(field.label);
    }
    labelled_ = true;
    next_ahead_ = row;
    note_lines_before("rows begin in line ", row);
    return true;
  }

  void add_units(const std::vector<std::string>& units) {
    for (std::size_t c = 0; c < names_.size(); ++c) {
      const std::string& unit = units[c];
      if (unit.empty() || unit == "-") continue;
      const bool brackets = unit.ends_with(']') || unit.ends_with(')');
      names_[c] += brackets ? ' ' + unit : " [" + unit + ']';
    }
  }

  void note_lines_before(const char* begins, std::size_t row) {
    if (row == 0) return;
    table_.notes.push_back("note: " + lines_.name() + ": " + begins +
                           std::to_string(ahead_[row].number) +
                           "; the lines before it are left out");
  }

  // Uses the names that the user gave, and skips lines before the first row.
  void take_given(const std::vector<std::string>& given) {
    names_ = given;
    std::size_t numbers = 0, first = 0;
    for (; first < 50 && look(first) && numbers == 0; ++first) {
      for (const char delimiter : {',', ';', '\t'}) {
        const auto fields = fields_of(ahead_[first].text, delimiter);
        if (!fields || fields->size() < given.size()) continue;
        const auto found = static_cast<std::size_t>(std::ranges::count_if(*fields, is_number));
        if (found > numbers) {
          numbers = found;
          delimiter_ = delimiter;
        }
      }
    }
    next_ahead_ = numbers == 0 ? 0 : first - 1;
    note_lines_before("rows begin in line ", next_ahead_);
  }

  void take_names() {
    if (trimmed(text_).empty()) fail(text_, "found no header; the first row names the columns");
    header_ = std::string(text_);
    std::unordered_set<std::string> seen;
    if (!fields_.take(text_, delimiter_)) {
      fail(text_, "found a quotation mark without its closing one");
    }
    for (const std::string_view name : fields_.all()) {
      if (std::ranges::any_of(name, is_control)) {
        fail(name, "found a control character in the header; a CSV file is plain text");
      }
      double number = 0;
      if (read_number(name, number) != Reading::no_number) {
        // As Arduino's serial monitor writes it: "12:00:01.250 -> 1.2,3.4".
        const bool stamped = text_.find(" -> ") != std::string_view::npos;
        fail(name, "found the number " + quoted(name, longest_name) +
                       "; the first row names the columns, or --header NAME,... does" +
                       (stamped ? ", once a comma takes the place of \" -> \" in each line" : ""));
      }
      if (!name.empty() && !seen.emplace(name).second) {
        fail(name, "column " + quoted(name, longest_name) + " appears twice");
      }
      names_.emplace_back(name);
    }
    name_the_nameless();
  }

  // A first column without a name is the index from pandas. A last one is the empty text after a
  // delimiter at the end of each line.
  void name_the_nameless() {
    const bool has_rows = next_ahead_ < ahead_.size();
    std::size_t at = 0;
    for (std::size_t c = 0; c < names_.size(); ++c) {
      std::string& name = names_[c];
      if (name.empty()) {
        const bool last = c + 1 == names_.size();
        const auto fields =
            has_rows ? fields_of(ahead_[next_ahead_].text, delimiter_) : std::nullopt;
        const bool index = c == 0 && !last && fields;
        const bool trailing =
            c > 0 && last && fields && fields->size() == names_.size() && (*fields)[c].empty();
        if (!index && !trailing) fail(text_.substr(at), "a column's name is empty");
        if (trailing) {
          names_.pop_back();
          return;
        }
        name = "index";
        if (std::ranges::count(names_, name) > 1) name = "row index";
      }
      at = std::min(text_.find(delimiter_, at), text_.size() - 1) + 1;
    }
  }

  // Returns false, without a row, if the line has too few fields.
  [[nodiscard]] bool read_row() {
    const auto read = [&](std::string_view field, std::size_t c) {
      if (c >= reads_.size()) {
        if (!field.empty()) beyond_ = true;
        return;
      }
      if (!reads_[c]) return;
      Column& column = table_.columns[c];
      double value = 0;
      switch (read_field(field, value)) {
        case Reading::number:
          column.numbers.push_back(value);
          if (!column.texts.empty()) column.texts.emplace_back();
          return;
        case Reading::no_number:
          if (field.empty() || is_gap(field)) return column.add_text("");
          if (column.first_text.line == 0) column.first_text = {number_, column_of(field)};
          return column.add_text(std::string(field));
        case Reading::too_large:
          fail(field, "column " + shown(names_[c]) + ": found " + quoted(field, longest_name) +
                          ", too large for a double (at most 1.8e308)");
      }
    };
    if (text_ == header_) {
      ++headers_again_;
      return true;
    }
    beyond_ = false;
    std::size_t found = 0;
    if (labelled_) {
      const std::vector<Labelled> fields = labelled_fields(text_);
      found = fields.size();
      const bool same = std::ranges::equal(fields, names_, {}, &Labelled::label);
      if (!same) return false;
      for (std::size_t c = 0; c < found; ++c) read(fields[c].value, c);
    } else {
      if (!fields_.take(text_, delimiter_)) {
        fail(text_, "found a quotation mark without its closing one");
      }
      found = fields_.all().size();
      if (found < names_.size()) return false;
      for (std::size_t c = 0; c < found; ++c) read(fields_.all()[c], c);
    }
    if (beyond_) take_beyond(found);
    ++table_.rows;
    return true;
  }

  // A logger that is switched on or off within a row cuts the first or the last one. A board prints
  // lines of words between its rows. Refuses other rows with too few fields.
  void leave_out_cut_row() {
    const std::size_t number = number_;
    const bool words = !labelled_ && std::ranges::none_of(*fields_of(text_, delimiter_), is_number);
    std::string found = count_text(labelled_ ? 0 : fields_of(text_, delimiter_)->size());
    if (words) {
      if (lines_of_words_++ == 0) first_words_ = number;
      return;
    }
    const bool first = table_.rows == 0 && !cut_first_;
    cut_first_ = cut_first_ || first;
    const bool more = next_row();
    if (first ? !more : more || table_.rows == 0) {
      throw InputError({Problem{lines_.name() + ":" + std::to_string(number) + ":1",
                                found + "; complete the row, or remove it"}});
    }
    table_.notes.push_back("warning: " + lines_.name() + ':' + std::to_string(number) + ": " +
                           found + "; the " + (first ? "first" : "last") +
                           " row is cut, and left out");
    if (first && !read_row()) leave_out_cut_row();
  }

  [[nodiscard]] std::string count_text(std::size_t found) const {
    const std::size_t expected = names_.size();
    if (labelled_) {
      return "found " + quoted(text_, longest_name) + "; the first row has " +
             std::to_string(expected) + (expected == 1 ? " label" : " labels") + ", " +
             joined(names_);
    }
    const auto fields = fields_of(text_, delimiter_);
    const bool numbers = std::ranges::all_of(*fields, is_number);
    return "found " + std::to_string(found) + (numbers ? " number" : " field") +
           (found == 1 ? "" : "s") + "; the header names " + std::to_string(expected) +
           (expected == 1 ? " column" : " columns");
  }

  void take_beyond(std::size_t found) {
    // With decimal points, commas do not mark decimals.
    if (table_.rows == 0 && delimiter_ == ',' && names_.size() > 1 && found == 2 * names_.size() &&
        text_.find('.') == std::string_view::npos) {
      fail(text_, count_text(found) +
                      "; name the others; or, if commas mark decimals, separate the columns by "
                      "semicolons or tabs");
    }
    if (rows_beyond_++ == 0)
      first_beyond_ = lines_.name() + ':' + std::to_string(number_) + ": " + count_text(found);
  }

  void note_rows() {
    const auto more = [](std::size_t rows) {
      return rows == 1 ? std::string()
                       : ", here and in " + std::to_string(rows - 1) +
                             (rows == 2 ? " more row" : " more rows");
    };
    if (rows_beyond_ > 0) {
      table_.notes.push_back("warning: " + first_beyond_ + "; the fields beyond are left out" +
                             more(rows_beyond_));
    }
    if (lines_of_words_ > 0) {
      table_.notes.push_back("warning: " + lines_.name() + ':' + std::to_string(first_words_) +
                             ": found words between the rows; left out" + more(lines_of_words_));
    }
    if (headers_again_ > 0) {
      table_.notes.push_back("note: " + lines_.name() + ": the header is repeated in " +
                             std::to_string(headers_again_) +
                             (headers_again_ == 1 ? " row" : " rows") + ", left out");
    }
  }

  // The column where a part of the current line begins, from 1; 1 for any other text.
  [[nodiscard]] std::size_t column_of(std::string_view part) const {
    const std::less_equal<> not_after;
    const bool within = part.data() != nullptr && not_after(text_.data(), part.data()) &&
                        not_after(part.data(), text_.data() + text_.size());
    return within ? static_cast<std::size_t>(part.data() - text_.data()) + 1 : 1;
  }

  // `at` is a part of the current line. The error gives its column.
  [[noreturn]] void fail(std::string_view at, const std::string& message) const {
    throw InputError({Problem{
        lines_.name() + ":" + std::to_string(number_) + ":" + std::to_string(column_of(at)),
        message}});
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
  bool beyond_ = false;      // the row has a field beyond the columns
  std::size_t rows_beyond_ = 0, headers_again_ = 0;
  std::size_t lines_of_words_ = 0, first_words_ = 0;
  std::string first_beyond_;
};

}  // namespace

Table read_csv(const std::string& file, const CsvChoice& choice) {
  return Parser(file).parse(choice);
}

}  // namespace bbsim::file
