// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What varies in a sweep, and what came of it.
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
  std::vector<double> values;         // one a case; of a text, its place in `labels`
  std::vector<double> distinct;       // in rising order
  std::vector<std::string> labels{};  // of a text, in the order in which they come
  std::string unit{};                 // as the file says; empty if it does not
  bool drawn = false;                 // by chance
  std::size_t leader = 0;             // the first key with which its values always go along

  [[nodiscard]] bool is_text() const { return !labels.empty(); }
};

struct SweepTable {
  std::vector<Key> keys;
  std::vector<std::string> status;  // a word a case
  std::vector<const Column*> measures;
  // Each way to end but `done`, in the order in which they come, and how many cases ended so.
  std::vector<std::pair<std::string, std::size_t>> others{};

  [[nodiscard]] bool done(std::size_t a_case) const { return status[a_case] == "done"; }
  // Names of the keys that go along with this one.
  [[nodiscard]] std::vector<std::string> followers(const Key& key) const;
};

// The columns before `status` are keys, the numbers after it measures; `end_time` is one of these
// if the cases did not all end at one time. Where the file does not say whether a key was drawn, it
// was if more than half of many cases have values of their own, in no order.
[[nodiscard]] SweepTable sweep_table(const Result& sweep);

}  // namespace bbsim::results
