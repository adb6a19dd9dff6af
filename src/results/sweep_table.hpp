// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The keys that vary in a sweep, and its results.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "results/result.hpp"

namespace bbsim::results {

// A key that has more than one value.
struct Key {
  std::string name;
  std::vector<double> values;         // one for each case; index into `labels` for a text
  std::vector<double> distinct;       // in increasing order
  std::vector<std::string> labels{};  // of a text, in order of appearance
  std::string unit{};                 // from the file; empty if unknown
  bool drawn = false;                 // at random
  std::size_t leader = 0;             // the first key that varies together with it

  [[nodiscard]] bool is_text() const { return !labels.empty(); }
};

struct SweepTable {
  std::vector<Key> keys;
  std::vector<std::string> status;  // one word for each case
  std::vector<const Column*> measures;
  // Each status except `done`, in order of appearance, and its number of cases.
  std::vector<std::pair<std::string, std::size_t>> others{};

  [[nodiscard]] bool done(std::size_t a_case) const { return status[a_case] == "done"; }
  // Names of the keys that vary together with this one.
  [[nodiscard]] std::vector<std::string> followers(const Key& key) const;
};

// Columns before `status` are keys, numbers after it measures. `end_time` is a measure if the cases
// end at different times. If the file does not tell, a key counts as drawn if more than half of
// many cases have distinct values in no order.
[[nodiscard]] SweepTable sweep_table(const Result& sweep);

}  // namespace bbsim::results
