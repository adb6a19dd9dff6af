// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "base/progress_line.hpp"
#include "base/quoted.hpp"
#include "signals.hpp"
#include "terminal.hpp"

namespace bbsim::app {

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
