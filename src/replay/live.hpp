// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What a live page shows beside its run: numbers to change, measures, tasks.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace bbsim::replay {

// A number that the text of a scenario has: its slider.
struct LiveKey {
  std::string key, text;              // controller.pd.kp, and its value as the text has it
  std::string unit;                   // of numbers in SI; may be empty
  double value = 0;                   // SI
  std::optional<double> least, most;  // the range of allowed values, SI; empty: unbounded
  bool open = false;                  // `least` itself is not allowed
  bool whole = false;                 // without fractions
  std::string meaning;                // one phrase; may be empty
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
  // The open loop of each command over the frequency, with the other one closed.
  struct Loops {
    struct Curve {
      std::string command;
      std::vector<double> gain, phase;  // rad
    };
    std::optional<double> period;  // s, of a sampled loop
    std::vector<double> frequencies;
    std::vector<Curve> curves;
    std::string margins;  // JSON, as `bbsim linearize` writes it
    bool stable = false;
  };
  std::vector<LiveKey> keys;      // in the order of their names
  std::vector<std::string> free;  // keys that a learner may change; empty: all
  std::vector<Task> tasks;
  std::vector<Measure> measures;
  std::optional<Loops> loops;  // of a loop that bbsim can linearize
};

class Numbers;
[[nodiscard]] nlohmann::ordered_json live_json(const Live& live, const Numbers& numbers);

}  // namespace bbsim::replay
