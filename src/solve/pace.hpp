// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Distinguishes a run that will never finish from one that takes long, and a rig that switches
// again and again from one that moves on.
//
// Near a singular point, or where the error test sees only rounding, steps become so short that a
// run goes on for days without progress. The step length alone says little: steps are short for a
// while in a transient, or before an event that ends the run. Pace therefore extrapolates
// repeatedly how many steps remain at the present pace.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>

namespace bbsim::solve {

// Detects a standstill: a hundred switches in a row without progress in time.
class Standstill {
 public:
  // Counts a switch at t (s). Returns whether the rig stands still.
  [[nodiscard]] bool after(double t) {
    const bool still = t - last_ <= 1e-13 * t;
    still_ = still ? still_ + 1 : 0;
    last_ = t;
    return still_ >= most;
  }

 private:
  static constexpr int most = 100;

  double last_ = -1;  // the last switch, s
  int still_ = 0;
};

class Pace {
 public:
  // `end`: the end of the run, s.
  explicit Pace(double end) : end_(end) {}

  // Returns whether to give up. Call it after each step that ends before its limit. Steps that end
  // at a stop, a sample or the run's end say nothing about the pace. `time`: the present time, s.
  // `event` returns the time (s) at which an event will end the run, extrapolated from its last
  // call. It is called once per window of steps.
  template <class Event>
  [[nodiscard]] bool creeps(double time, Event event) {
    return ++steps_ % window == 0 && judge(time, event());
  }
  [[nodiscard]] bool creeps(double time) {
    return creeps(time, [] { return std::numeric_limits<double>::infinity(); });
  }

  // Whether the last call of creeps() completed a window of 4096 steps and checked the pace.
  [[nodiscard]] bool completed_window() const { return steps_ % window == 0; }

  // Steps per second of motion at present, 1/s, and steps left at that pace. Valid after
  // completed_window().
  [[nodiscard]] double steps_per_second() const { return static_cast<double>(window) / advance_; }
  [[nodiscard]] double steps_left() const { return (end_ - from_) * steps_per_second(); }

  // Whether to report a slow run now: a second of motion takes over a million steps, and the rest
  // of the run over a second or so of work. True at most once. Call it after completed_window().
  [[nodiscard]] bool is_news() {
    constexpr double a_million = 1e6, some_work = 1e5;
    const bool slow = steps_ > 0 && steps_per_second() > a_million && steps_left() > some_work;
    return slow && !std::exchange(told_, true);
  }

  // Why the run was given up, for Outcome::reason.
  [[nodiscard]] std::string reason() const;

 private:
  static constexpr std::size_t window = 4096;
  // A run with more steps is given up. So many take the fastest integrator hours.
  static constexpr double most_steps = 1e10;
  // The run is given up after this many consecutive windows that leave the end out of reach: with
  // shrinking advances, or with any. A transient passes in half a million steps.
  static constexpr int most_shrinking = 6, most_slow = 128;
  // Waits for an event that is at most `soon` windows away, and for at most `most_awaited` windows.
  static constexpr int soon = 64, most_awaited = 128;

  bool judge(double time, double event);

  double end_;
  std::size_t steps_ = 0;
  double from_ = 0;                   // start of the present window, s
  double advance_ = 0;                // of the last whole window, s
  std::array<double, 4> advances_{};  // of the last windows, s
  std::size_t windows_ = 0;
  int shrinking_ = 0, slow_ = 0, awaited_ = 0;
  bool told_ = false;
};

}  // namespace bbsim::solve
