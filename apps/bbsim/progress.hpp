// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A progress bar on a terminal, for anything that takes over a second; elsewhere, where asked for,
// a line a minute.
#pragma once

#include <chrono>
#include <string>

namespace bbsim::app {

class Progress {
 public:
  // Draws on standard error if that is a terminal and `quiet` is not set; a line a minute where it
  // is none, if `lines` is set.
  Progress(const std::string& label, bool quiet, bool lines = false);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // The work begins now, at `fraction`, such as what an earlier process has done of it: the time
  // left is told from what is done from here on.
  void start(double fraction);

  // `fraction` in [0, 1]; `detail` follows it. Cheap: it draws at most ten times a second.
  void update(double fraction, const std::string& detail = "");

  // Takes the bar away, so that messages start on a line of their own.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  std::string label_;
  bool bar_, lines_;
  bool drawn_ = false;
  double first_ = 0;
  Clock::time_point start_, last_;
};

}  // namespace bbsim::app
