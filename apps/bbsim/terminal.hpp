// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Output for people. All messages and reports pass through here and so through printable(): names
// of files, columns and keys come from others, and terminals obey escape sequences. Results for
// programs (CSV, JSON, HDF5) are written unchanged.
//
// During work a terminal shows a progress bar after a second; elsewhere, on request, there is a
// line a minute. SIGINT (Ctrl-C), SIGTERM and SIGHUP end the program with exit code 130 and leave
// no temporary files; a run that watches them keeps its results so far.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>

#include "api/watch.hpp"

namespace bbsim::app {

// Writes a message and a line break to standard error.
void say(std::string_view message);

// Writes a requested report to standard output. Throws OutputError.
void print(const std::string& report);

// The columns for text on a stream that is a terminal; 0 if it is none. Asks the terminal each
// time, since it may have been resized. The last column stays free, because some terminals break
// the line there.
[[nodiscard]] std::size_t columns_of(int descriptor);

// Whether the program can ask questions: standard input and standard error are terminals.
[[nodiscard]] bool can_ask();

// If the file is standard input and that is a terminal, says that the program waits for `what`.
void say_if_waiting(const std::string& file, const std::string& what, bool quiet);

// Wraps a text into lines of at most `width` columns that start at column `indent`; the first one
// is at `column` already. Longer words stay whole.
[[nodiscard]] std::string wrapped(std::string_view text, std::size_t indent, std::size_t column,
                                  std::size_t width);

class Progress : public api::Watch {
 public:
  // Draws on standard error if that is a terminal and `quiet` is not set. Elsewhere prints a line a
  // minute if `lines` is set.
  Progress(const std::string& label, bool quiet, bool lines = false);
  ~Progress() override;
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // The estimate of the time left uses only progress from here on.
  void start(double fraction) override;
  // Cheap: draws at most ten times a second.
  void update(double fraction, const std::string& detail) override;
  // Removes the bar, so that messages start on a new line.
  void end() override;

  void note(const std::string& text) override;
  void warn(const std::string& text) override;
  void controller_says(std::string_view line) override;
  // Set by signals. Before the first call, signals end the process at once.
  [[nodiscard]] const std::atomic<bool>* stop() override;

 private:
  using Clock = std::chrono::steady_clock;
  std::string label_;
  bool quiet_, bar_, lines_;
  bool drawn_ = false;
  double first_ = 0;
  Clock::time_point start_, last_;
};

// From now on each of these signals ends the process at once. An ignored SIGHUP (nohup) stays
// ignored.
void end_at_signals();

// Becomes true when a signal asks the process to end. From now on only a second signal ends it at
// once.
const std::atomic<bool>& watch_signals();

}  // namespace bbsim::app
