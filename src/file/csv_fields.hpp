// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The fields of a line of CSV, and the numbers in them: read, and written for rows of a sweep. Text
// with a comma, a quote or a line break is quoted (RFC 4180).
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "base/number_text.hpp"

namespace bbsim::file {

inline void append_number(std::string& line, double value) {
  char text[longest_number];
  line.append(text, write_number(text, value));
}

void append_text(std::string& line, std::string_view text);

// Splits a line without its line break into unquoted fields. Returns false if a quote stays open.
[[nodiscard]] bool split_fields(std::string_view line, std::vector<std::string>& fields,
                                char delimiter = ',');

// Reads the whole text as a number, rounded to the nearest double.
enum class Reading { number, no_number, too_large };
[[nodiscard]] Reading read_number(std::string_view text, double& value);
// Also reads a decimal comma that is not a delimiter.
[[nodiscard]] Reading read_field(std::string_view field, double& value);
[[nodiscard]] bool is_number(std::string_view field);

// Whether the field is empty, or one of the words that loggers write for a missing value.
[[nodiscard]] bool is_gap(std::string_view field);
// Whether a field may be a unit. Some loggers write units below the names, in a second line.
[[nodiscard]] bool is_unit(std::string_view field);

// The fields of a line without blanks around them: parts of the line, or copies if the line has
// quotation marks.
class Fields {
 public:
  // Returns false if a quote stays open.
  bool take(std::string_view line, char delimiter);
  // Takes the values of a line such as "x:0.01 y:0.02 t:120", which the Arduino's serial plotter
  // shows, between blanks, tabs, commas or semicolons. Returns false for any other line. A label
  // begins with a letter, so that a time of day is none.
  bool take_labelled(std::string_view line);

  [[nodiscard]] const std::vector<std::string_view>& all() const { return all_; }
  [[nodiscard]] std::size_t size() const { return all_.size(); }
  [[nodiscard]] const std::vector<std::string_view>& labels() const { return labels_; }
  // The column of the line where a field begins, from 1. The line must still be there.
  [[nodiscard]] std::size_t column(std::size_t field) const {
    const char* const start = starts_.empty() ? all_[field].data() : starts_[field];
    return static_cast<std::size_t>(start - line_.data()) + 1;
  }

 private:
  void begin(std::string_view line);
  void add(std::size_t start, std::size_t end);

  std::string_view line_;
  std::vector<std::string_view> all_, labels_;
  std::vector<const char*> starts_;  // of a line with quotation marks
  std::vector<std::string> unquoted_;
};

}  // namespace bbsim::file
