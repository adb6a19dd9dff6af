// A progress bar on a terminal, for anything that takes over a second.
#pragma once

#include <chrono>
#include <string>

namespace bbsim::app {

class Progress {
 public:
  // Draws on standard error if that is a terminal and `quiet` is not set.
  Progress(std::string label, bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // `fraction` in [0, 1]. Cheap: it draws at most ten times a second.
  void update(double fraction);

  // Takes the bar away, so that messages start on a line of their own.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  std::string label_;
  bool on_;
  bool drawn_ = false;
  Clock::time_point start_, last_;
};

}  // namespace bbsim::app
