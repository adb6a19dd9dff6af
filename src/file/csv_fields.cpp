// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/csv_fields.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include "base/text.hpp"

namespace bbsim::file {

void append_text(std::string& line, std::string_view text) {
  if (text.find_first_of(",\"\n\r") == std::string_view::npos) {
    line += text;
    return;
  }
  line += '"';
  for (const char c : text) {
    if (c == '\n' || c == '\r') {
      line += ' ';  // each row must stay on one line
      continue;
    }
    if (c == '"') line += '"';
    line += c;
  }
  line += '"';
}

bool split_fields(std::string_view line, std::vector<std::string>& fields, char delimiter) {
  fields.clear();
  std::string field;
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"') {
      if (quoted && i + 1 < line.size() && line[i + 1] == '"') {
        field += line[++i];
      } else {
        quoted = !quoted;
      }
    } else if (c == delimiter && !quoted) {
      fields.push_back(std::move(field));
      field.clear();
    } else {
      field += c;
    }
  }
  fields.push_back(std::move(field));
  return !quoted;
}

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

bool is_gap(std::string_view field) {
  constexpr std::array<std::string_view, 7> words = {"",     "NA",   "N/A", "#N/A",
                                                     "null", "NULL", "None"};
  return std::ranges::find(words, field) != words.end();
}

bool is_unit(std::string_view field) {
  constexpr std::array<std::string_view, 16> units = {"",      "-",   "s",   "ms", "us",  "m",
                                                      "cm",    "mm",  "deg", "°",  "rad", "deg/s",
                                                      "rad/s", "m/s", "V",   "A"};
  if (std::ranges::find(units, field) != units.end()) return true;
  return (field.starts_with('[') && field.ends_with(']')) ||
         (field.starts_with('(') && field.ends_with(')'));
}

void Fields::begin(std::string_view line) {
  line_ = line;
  all_.clear();
  labels_.clear();
  starts_.clear();
}

void Fields::add(std::size_t start, std::size_t end) {
  const std::string_view whole = line_.substr(start, end - start), field = trimmed(whole);
  all_.push_back(field.empty() ? whole.substr(0, 0) : field);
}

bool Fields::take(std::string_view line, char delimiter) {
  begin(line);
  if (line.find('"') == std::string_view::npos) {
    for (std::size_t start = 0;;) {
      const std::size_t end = std::min(line.find(delimiter, start), line.size());
      add(start, end);
      if (end == line.size()) return true;
      start = end + 1;
    }
  }
  bool quoted = false;
  for (std::size_t i = 0, start = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') quoted = !quoted;
    if (i < line.size() && (quoted || line[i] != delimiter)) continue;
    add(start, i);
    start = i + 1;
  }
  for (const std::string_view field : all_) starts_.push_back(field.data());
  all_.clear();
  if (!split_fields(line, unquoted_, delimiter)) return false;
  for (const std::string& field : unquoted_) all_.push_back(trimmed(field));
  return true;
}

bool Fields::take_labelled(std::string_view line) {
  constexpr std::string_view between = " \t,;";
  begin(line);
  std::size_t at = line.find_first_not_of(" \t");
  while (at < line.size()) {
    const std::size_t colon = line.find(':', at);
    const std::string_view label = line.substr(at, colon - at);
    if (colon == std::string_view::npos || label.empty() ||
        std::isalpha(static_cast<unsigned char>(label[0])) == 0 ||
        label.find_first_of(between) != std::string_view::npos) {
      return false;
    }
    const std::size_t start = std::min(line.find_first_not_of(" \t", colon + 1), line.size());
    const std::size_t end = std::min(line.find_first_of(between, start), line.size());
    add(start, end);
    if (all_.back().empty() || (!is_number(all_.back()) && !is_gap(all_.back()))) return false;
    labels_.push_back(label);
    at = line.find_first_not_of(between, end);
  }
  return !all_.empty();
}

}  // namespace bbsim::file
