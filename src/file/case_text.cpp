// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/case_text.hpp"

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

}  // namespace bbsim::file
