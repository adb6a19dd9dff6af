// A strict reader of CSV: a header of bare names, then as many numbers a row.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "base/error.hpp"
#include "record/atomic_file.hpp"
#include "record/formats.hpp"

namespace bbsim::record {
namespace {

std::string read_whole(const std::string& file) {
  const bool standard_input = file == "-";
  const int descriptor = standard_input ? STDIN_FILENO : open(file.c_str(), O_RDONLY | O_CLOEXEC);
  int error = descriptor < 0 ? errno : 0;
  std::string text;
  std::size_t size = 0;
  struct stat status {};
  if (error == 0 && fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode)) {
    text.resize(static_cast<std::size_t>(status.st_size) + 1);  // room to find the end in
  }
  while (error == 0) {
    constexpr std::size_t at_least = 65536;
    if (text.size() == size) text.resize(std::max(2 * size, at_least));
    const ssize_t got = read(descriptor, text.data() + size, text.size() - size);
    if (got == 0) break;
    if (got > 0) size += static_cast<std::size_t>(got);
    if (got < 0 && errno != EINTR) error = errno;
  }
  if (descriptor >= 0 && !standard_input) close(descriptor);
  if (error != 0) throw InputError("cannot read " + file + ": " + error_text(error));
  text.resize(size);
  return text;
}

bool is_blank(char c) {
  return c == ' ' || c == '\t';
}
bool is_control(char c) {
  return static_cast<unsigned char>(c) < ' ' || c == '\x7f';
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

// What was found, fit for a terminal: quoted, cut short, control characters replaced.
std::string shown(std::string_view text) {
  if (text.empty()) return "nothing";
  constexpr std::size_t longest = 40;
  std::string quoted(text.substr(0, longest));
  std::replace_if(quoted.begin(), quoted.end(), is_control, '?');
  quoted.insert(quoted.begin(), '"');
  return quoted.append(text.size() > longest ? "...\"" : "\"");
}

// Reads the number that `text` is, as a whole, to the nearest double.
enum class Reading { number, no_number, too_large };
Reading read_number(std::string_view text, double& value) {
  // from_chars knows no plus sign.
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error == std::errc::invalid_argument || stop != end) return Reading::no_number;
  if (error == std::errc::result_out_of_range) {  // also a tiny one, whose nearest double is 0
    value = std::strtod(std::string(text).c_str(), nullptr);
    if (std::isinf(value)) return Reading::too_large;
  }
  return Reading::number;
}

class Parser {
 public:
  Parser(const std::string& file, std::string_view text) : file_(file), rest_(text) {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (rest_.starts_with(byte_order_mark)) rest_.remove_prefix(byte_order_mark.size());
  }

  TableData parse() {
    next_line();
    if (trimmed(text_).empty()) fail(text_, "found no header; the first row names the columns");
    read_header();
    // Enough for equally long rows, so that few vectors grow.
    const std::size_t rows = rest_.size() / (2 * table_.names.size()) + 1;
    constexpr std::size_t most = 4096;
    for (auto& column : table_.columns) column.reserve(std::min(rows, most));
    while (next_line()) read_row();
    return std::move(table_);
  }

 private:
  bool next_line() {
    if (rest_.empty()) return false;
    const std::size_t end = rest_.find('\n');
    text_ = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    if (text_.ends_with('\r')) text_.remove_suffix(1);
    ++line_;
    return true;
  }

  // Calls use(field, its number) for each field of the line; returns how many there are.
  template <class Use>
  std::size_t for_each_field(Use use) const {
    std::size_t count = 0;
    for (std::size_t start = 0;;) {
      const std::size_t comma = text_.find(',', start);
      use(trimmed(text_.substr(start, comma - start)), count++);  // npos - start: to the end
      if (comma == std::string_view::npos) return count;
      start = comma + 1;
    }
  }

  void read_header() {
    for_each_field([this](std::string_view name, std::size_t) {
      double number = 0;
      if (name.empty()) fail(name, "a column's name is empty");
      if (name.find(';') != std::string_view::npos || name.find('\t') != std::string_view::npos) {
        fail(name, "found " + shown(name) + "; commas separate columns");
      }
      if (std::any_of(name.begin(), name.end(), is_control)) {
        fail(name, "found a control character in the header; a CSV file is plain text");
      }
      if (name.find('"') != std::string_view::npos) {
        fail(name, "found " + shown(name) + "; names stand without quotation marks");
      }
      if (read_number(name, number) != Reading::no_number) {
        fail(name, "found the number " + shown(name) + "; the first row names the columns");
      }
      if (std::find(table_.names.begin(), table_.names.end(), name) != table_.names.end()) {
        fail(name, "column " + shown(name) + " is there twice");
      }
      table_.names.emplace_back(name);
    });
    table_.columns.resize(table_.names.size());
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
      fail(field, "column " + table_.names[c] + ": found " + shown(field) +
                      (reading == Reading::too_large ? ", too large for a double (at most 1.8e308)"
                                                     : ", a number is expected"));
    });
    if (found != expected) {
      fail(text_, "found " + std::to_string(found) + (found == 1 ? " number" : " numbers") +
                      "; the header names " + std::to_string(expected) +
                      (expected == 1 ? " column" : " columns"));
    }
  }

  // `at` is a part of the line, for the column of the message.
  [[noreturn]] void fail(std::string_view at, const std::string& message) const {
    const auto column = at.data() == nullptr ? 0 : at.data() - text_.data();
    throw InputError({Problem{file_ + ":" + std::to_string(std::max<std::size_t>(line_, 1)) + ":" +
                                  std::to_string(column + 1),
                              message}});
  }

  const std::string& file_;
  std::string_view rest_;  // after the current line
  std::string_view text_;  // the current line, without its end
  std::size_t line_ = 0;   // its number, from 1
  TableData table_;
};

}  // namespace

TableData read_csv(const std::string& file) {
  const std::string text = read_whole(file);
  return Parser(file == "-" ? "standard input" : file, text).parse();
}

}  // namespace bbsim::record
