// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Output for people. All messages and reports pass through here and so through printable(): names
// of files, columns and keys come from others, and terminals obey escape sequences. Results for
// programs (CSV, JSON, HDF5) are written unchanged.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace bbsim::app {

// Writes a message and a line break to standard error.
void say(std::string_view message);

// Writes a requested report to standard output. Throws OutputError.
void print(const std::string& report);

// The columns for text on a stream that is a terminal; 0 if it is none. Asks the terminal each
// time, since it may have been resized. The last column stays free, because some terminals break
// the line there.
[[nodiscard]] std::size_t columns_of(int descriptor);

// Whether standard error is a terminal that obeys escape sequences (TERM=dumb does not).
[[nodiscard]] bool draws_on_terminal();

// Escape sequence that clears the terminal's current line, if draws_on_terminal().
inline constexpr const char* to_clear_line = "\r\033[K";

// Whether the program can ask questions: standard input and standard error are terminals.
[[nodiscard]] bool can_ask();

// If the file is standard input and that is a terminal, says that the program waits for `what`.
void say_if_waiting(const std::string& file, const std::string& what, bool quiet);

// Wraps a text into lines of at most `width` columns that start at column `indent`; the first one
// is at `column` already. Longer words stay whole.
[[nodiscard]] std::string wrapped(std::string_view text, std::size_t indent, std::size_t column,
                                  std::size_t width);

}  // namespace bbsim::app
