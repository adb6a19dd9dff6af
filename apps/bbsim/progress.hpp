// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Messages during work: on a terminal, a progress bar for work that takes over a second; elsewhere,
// on request, a line a minute.
#pragma once

#include <chrono>
#include <string>

#include "api/watch.hpp"

namespace bbsim::app {

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

}  // namespace bbsim::app
