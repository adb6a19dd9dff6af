// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What the program says to people. Every message and every report goes through here, and so through
// printable(): names of files, columns and keys come from others, and a terminal obeys what it is
// sent. Results that programs read (CSV, JSON, HDF5) do not: they are written as they are.
#pragma once

#include <string>
#include <string_view>

namespace bbsim::app {

// A message, to standard error; a line break is added.
void say(std::string_view message);

// A report that was asked for, to standard output. Throws OutputError.
void print(const std::string& report);

// Whether standard error is a terminal that obeys escape sequences (TERM=dumb does not).
[[nodiscard]] bool draws_on_terminal();

// What empties the terminal's present line, if it does.
inline constexpr const char* to_clear_line = "\r\033[K";

// Whether someone can be asked: standard input and standard error are terminals.
[[nodiscard]] bool can_ask();

// If that file is standard input, and that a terminal, says that the program waits for `what`
// there.
void say_if_waiting(const std::string& file, const std::string& what, bool quiet);

}  // namespace bbsim::app
