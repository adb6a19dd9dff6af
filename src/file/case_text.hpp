// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Rows of a sweep as CSV text (RFC 4180: a text with a comma, a quote or a line break is quoted).
#pragma once

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

// The fields of a line without its line break, unquoted. False if a quote is left open.
[[nodiscard]] bool split_fields(std::string_view line, std::vector<std::string>& fields);

}  // namespace bbsim::file
