// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Rows of a sweep as CSV text. Text with a comma, a quote or a line break is quoted (RFC 4180).
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

// Splits a line without its line break into unquoted fields. Returns false if a quote stays open.
[[nodiscard]] bool split_fields(std::string_view line, std::vector<std::string>& fields,
                                char delimiter = ',');

}  // namespace bbsim::file
