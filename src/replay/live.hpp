// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What a live page shows beside its run: numbers to change, measures, tasks.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace bbsim::replay {

// A number that the text of a scenario has: its slider.
struct LiveKey {
  std::string key, text;              // controller.pd.kp, and its value as the text has it
  double value = 0;                   // SI
  std::optional<double> least, most;  // the range of allowed values, SI; empty: unbounded
  bool open = false;                  // `least` itself is not allowed
  bool whole = false;                 // without fractions
};

struct Live {
  struct Task {
    std::string text, expect;  // as in `exercise`
    bool holds = false;
  };
  struct Measure {
    std::string name, unit;
    double value = 0;
  };
  std::vector<LiveKey> keys;      // in the order of their names
  std::vector<std::string> free;  // keys that a learner may change; empty: all
  std::vector<Task> tasks;
  std::vector<Measure> measures;
};

}  // namespace bbsim::replay
