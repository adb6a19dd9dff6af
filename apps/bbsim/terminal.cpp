// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "terminal.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

#include "base/progress_line.hpp"
#include "base/text.hpp"
#include "file/atomic_file.hpp"

namespace bbsim::app {
namespace {

// Escape sequence that clears the terminal's current line, if draws_on_terminal().
constexpr const char* to_clear_line = "\r\033[K";

// Whether standard error is a terminal that obeys escape sequences (TERM=dumb does not).
bool draws_on_terminal() {
  const char* const kind = std::getenv("TERM");
  return isatty(STDERR_FILENO) == 1 && (kind == nullptr || std::strcmp(kind, "dumb") != 0);
}

}  // namespace

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

using namespace std::chrono_literals;

void Progress::controller_says(std::string_view line) {
  if (quiet_) return;
  // Replaces the progress bar, which is drawn again below the line.
  if (draws_on_terminal()) std::fputs(to_clear_line, stderr);
  say("controller: " + std::string(line));
}

Progress::Progress(const std::string& label, bool quiet, bool lines)
    : label_(printable(label)),
      quiet_(quiet),
      bar_(!quiet && draws_on_terminal()),
      lines_(lines && !quiet && !bar_),
      start_(Clock::now()),
      last_(start_) {}

Progress::~Progress() {
  Progress::end();
}

void Progress::end() {
  if (drawn_) std::fputs(to_clear_line, stderr);
  drawn_ = false;
}

void Progress::note(const std::string& text) {
  if (!quiet_) Progress::warn(text);
}

void Progress::warn(const std::string& text) {
  end();
  say(text);
}

const std::atomic<bool>* Progress::stop() {
  return &watch_signals();
}

void Progress::start(double fraction) {
  first_ = fraction;
  start_ = Clock::now();
}

void Progress::update(double fraction, const std::string& detail) {
  if (!bar_ && !lines_) return;
  const Clock::time_point now = Clock::now();
  if (now - start_ < 1s || now - last_ < (bar_ ? 100ms : 60s)) return;
  last_ = now;
  ProgressState state{label_, printable(detail), std::clamp(fraction, 0.0, 1.0)};
  if (state.done - first_ > 0.01 * (1 - first_)) {
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    state.seconds_left = elapsed * (1 - state.done) / (state.done - first_);
  }
  if (lines_) {
    say(log_line(state));
    return;
  }
  drawn_ = true;
  const std::string line = to_clear_line + progress_line(state, columns_of(STDERR_FILENO));
  std::fputs(line.c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace bbsim::app
