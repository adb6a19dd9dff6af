// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Tells a run that will not come to its end from one that takes long.
//
// Near a singular point, or where rounding is all that an error test sees, steps become so short
// that a run goes on for days without getting anywhere. Steps as such say little: they are short
// for a while where a transient passes, or where an event soon ends the run. So the question is how
// many more it would take at the pace of the last ones, and it is asked again and again.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>

namespace bbsim::solve {

class Pace {
 public:
  // The run is to go to `end`, s.
  explicit Pace(double end) : end_(end) {}

  // Tells whether to give up; to be called after each step that fell short of its limit: one that
  // ended at a stop, a sample or the end says nothing. `time` is where the run is, s. `event` tells
  // when something will end the run, if it comes on as it has since `event` was last called, s;
  // that is now and then.
  template <class Event>
  [[nodiscard]] bool creeps(double time, Event event) {
    return ++steps_ % window == 0 && look(time, event());
  }
  [[nodiscard]] bool creeps(double time) {
    return creeps(time, [] { return std::numeric_limits<double>::infinity(); });
  }

  // Whether the last call looked at how far it is, as one of some thousands does.
  [[nodiscard]] bool looked() const { return steps_ % window == 0; }

  // What it remembers (base/archive.hpp).
  template <class Archive>
  void archive(Archive& archive) {
    archive(steps_, from_, advance_, advances_, windows_, shrinking_, slow_, awaited_);
    for (const int count : {shrinking_, slow_, awaited_}) {
      archive.require(count >= 0 && count < 1 << 30);
    }
  }

  // How many steps a second of motion takes at present, 1/s, and how many are left at that pace;
  // after looked().
  [[nodiscard]] double steps_per_second() const { return static_cast<double>(window) / advance_; }
  [[nodiscard]] double steps_left() const { return (end_ - from_) * steps_per_second(); }

  // Whether it is time to say so: once, where a second of motion takes a million steps and the rest
  // more than a second or so of work. To be called after looked().
  [[nodiscard]] bool is_news() {
    constexpr double a_million = 1e6, some_work = 1e5;
    const bool slow = steps_ > 0 && steps_per_second() > a_million && steps_left() > some_work;
    return slow && !std::exchange(told_, true);
  }

  // Why, as Outcome::reason.
  [[nodiscard]] std::string reason() const;

 private:
  static constexpr std::size_t window = 4096;
  // Hours of the fastest integrator: more steps than this are not waited for.
  static constexpr double most_steps = 1e10;
  // Windows in a row in which the end stays out of reach while the steps become shorter than some
  // windows before, and windows whatever they do: a transient passes in half a million steps.
  static constexpr int most_shrinking = 6, most_slow = 128;
  // An event is waited for that is so many windows away, and for so many.
  static constexpr int soon = 64, most_awaited = 128;

  bool look(double time, double event);

  double end_;
  std::size_t steps_ = 0;
  double from_ = 0;                   // where the last window began, s
  double advance_ = 0;                // how far it came, s
  std::array<double, 4> advances_{};  // of the last windows
  std::size_t windows_ = 0;
  int shrinking_ = 0, slow_ = 0, awaited_ = 0;
  bool told_ = false;
};

}  // namespace bbsim::solve
