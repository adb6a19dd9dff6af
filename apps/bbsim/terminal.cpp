// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "terminal.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

#include "base/quoted.hpp"
#include "file/atomic_file.hpp"

namespace bbsim::app {

void say(std::string_view message) {
  try {
    const std::string line = printable(message) + '\n';
    // Write in one piece, so that other processes cannot split the message.
    static_cast<void>(std::fwrite(line.data(), 1, line.size(), stderr));
  } catch (const std::bad_alloc&) {
    std::fputs("out of memory\n", stderr);
  }
}

std::size_t columns_of(int descriptor) {
  if (isatty(descriptor) != 1) return 0;
  winsize size{};
  const bool has_width = ioctl(descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return has_width ? std::size_t{size.ws_col} - 1 : 79;
}

bool draws_on_terminal() {
  const char* const kind = std::getenv("TERM");
  return isatty(STDERR_FILENO) == 1 && (kind == nullptr || std::strcmp(kind, "dumb") != 0);
}

bool can_ask() {
  return isatty(STDIN_FILENO) == 1 && isatty(STDERR_FILENO) == 1;
}

void say_if_waiting(const std::string& file, const std::string& what, bool quiet) {
  if (quiet || file != "-" || isatty(STDIN_FILENO) != 1) return;
  say("reading " + what + " from the terminal; Ctrl-D ends it, Ctrl-C ends bbsim");
}

void print(const std::string& report) {
  file::write_file("-", printable(report));
}

std::string wrapped(std::string_view text, std::size_t indent, std::size_t column,
                    std::size_t width) {
  std::string result;
  bool first = true;
  while (!text.empty()) {
    const std::size_t end = text.find(' ');
    const std::string_view word = text.substr(0, end);
    if (!first && column + 1 + word.size() > width) {
      result += '\n' + std::string(indent, ' ');
      column = indent;
    } else if (!first) {
      result += ' ';
      ++column;
    }
    result += word;
    column += word.size();
    first = false;
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return result;
}

}  // namespace bbsim::app
