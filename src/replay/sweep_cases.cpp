// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "replay/sweep_cases.hpp"

#include <algorithm>
#include <set>
#include <string>

namespace bbsim::replay {
namespace {

// The rank of each case's value among the distinct values of a key.
struct Levels {
  std::vector<std::size_t> of_case;
  std::size_t count = 0;
};

template <class Value>
Levels levels_of(const std::vector<Value>& values) {
  std::vector<Value> distinct = values;
  std::ranges::sort(distinct);
  const auto end = std::unique(distinct.begin(), distinct.end());
  Levels levels{{}, static_cast<std::size_t>(end - distinct.begin())};
  for (const Value& value : values) {
    levels.of_case.push_back(std::lower_bound(distinct.begin(), end, value) - distinct.begin());
  }
  return levels;
}

bool is_grid(const std::vector<Levels>& keys, std::size_t cases) {
  double combinations = 1;
  for (const Levels& key : keys) combinations *= static_cast<double>(key.count);
  if (combinations != static_cast<double>(cases)) return false;
  std::set<std::size_t> seen;
  for (std::size_t i = 0; i < cases; ++i) {
    std::size_t number = 0;
    for (const Levels& key : keys) number = number * key.count + key.of_case[i];
    seen.insert(number);
  }
  return seen.size() == cases;
}

}  // namespace

std::vector<std::size_t> cases_kept(const Sweep& sweep, std::size_t most) {
  const std::size_t cases = sweep.status.size();
  std::vector<Levels> keys;
  for (const SweepColumn& key : sweep.keys) {
    if (!key.along.empty()) continue;
    keys.push_back(key.words.empty() ? levels_of(key.values) : levels_of(key.words));
  }
  std::vector<std::size_t> strides(keys.size(), 1);
  std::size_t every = 1;
  if (cases > most && is_grid(keys, cases)) {
    const auto left = [&](std::size_t k) { return (keys[k].count + strides[k] - 1) / strides[k]; };
    const auto total = [&] {
      std::size_t product = 1;
      for (std::size_t k = 0; k < keys.size(); ++k) product *= left(k);
      return product;
    };
    while (total() > most) {
      std::size_t longest = 0;
      for (std::size_t k = 1; k < keys.size(); ++k) {
        if (left(k) > left(longest)) longest = k;
      }
      strides[longest] *= 2;
    }
  } else {
    every = (cases + most - 1) / most;
  }
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < cases; i += std::max<std::size_t>(every, 1)) {
    bool keep = true;
    for (std::size_t k = 0; k < keys.size(); ++k) keep &= keys[k].of_case[i] % strides[k] == 0;
    if (keep) kept.push_back(i);
  }
  return kept;
}

}  // namespace bbsim::replay
