// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What the program says while it works. A progress bar on a terminal, for anything that takes over
// a second; elsewhere, where asked for, a line a minute.
#pragma once

#include <chrono>
#include <string>

#include "api/watch.hpp"

namespace bbsim::app {

class Progress : public api::Watch {
 public:
  // Draws on standard error if that is a terminal and `quiet` is not set; a line a minute where it
  // is none, if `lines` is set.
  Progress(const std::string& label, bool quiet, bool lines = false);
  ~Progress() override;
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // The time left is told from what is done from here on.
  void start(double fraction) override;
  // Cheap: it draws at most ten times a second.
  void update(double fraction, const std::string& detail) override;
  // Takes the bar away, so that messages start on a line of their own.
  void end() override;

  void note(const std::string& text) override;
  void warn(const std::string& text) override;
  void controller_says(std::string_view line) override;
  // Signals, which end the process at once before this is called.
  [[nodiscard]] const std::atomic<bool>* stop() override;

 private:
  using Clock = std::chrono::steady_clock;
  std::string label_;
  bool quiet_, bar_, lines_;
  bool drawn_ = false;
  double first_ = 0;
  Clock::time_point start_, last_;
};

}  // namespace bbsim::app
