// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "scenario/log_clock.hpp"

#include <algorithm>
#include <cmath>

#include "base/number_text.hpp"

namespace bbsim::scenario {
namespace {

constexpr double two_to_32 = 4294967296.0;
constexpr double earliest_epoch = 1e8;  // s: 1973 in Unix time, and three years for other clocks

std::string rows_text(std::size_t count, const char* what, std::size_t first) {
  return std::to_string(count) + (count == 1 ? " row" : " rows") + what + ", first in row " +
         std::to_string(first + 1);
}

}  // namespace

std::optional<std::string> unwrap(std::vector<double>& times) {
  const auto is_counter = [](double t) { return std::abs(t) <= two_to_32 && t == std::trunc(t); };
  double added = 0, before = std::nan("");
  std::size_t wraps = 0, first = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double t = times[i];
    if (std::isnan(t)) continue;
    if (is_counter(t) && is_counter(before) && before - t > two_to_32 / 2) {
      added += two_to_32;
      if (wraps++ == 0) first = i;
    }
    before = t;
    times[i] += added;
  }
  if (wraps == 0) return {};
  return "its clock of 32 bits wraps " +
         (wraps == 1 ? std::string("once") : std::to_string(wraps) + " times") + ", first in row " +
         std::to_string(first + 1) + "; 2^32 is added from there on";
}

Clock clock_of(const std::vector<double>& times) {
  Clock clock;
  std::size_t without = 0, first_without = 0, unsorted = 0, first_unsorted = 0;
  double latest = -INFINITY;
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!std::isfinite(times[i])) {
      if (without++ == 0) first_without = i;
      continue;
    }
    if (times[i] < latest && unsorted++ == 0) first_unsorted = i;
    latest = std::max(latest, times[i]);
    clock.rows.push_back(i);
  }
  if (without > 0) {
    clock.done.push_back(rows_text(without, " without a time", first_without) + "; left out");
  }
  if (unsorted > 0) {
    std::ranges::stable_sort(clock.rows, {}, [&](std::size_t row) { return times[row]; });
    clock.done.push_back(rows_text(unsorted, " earlier than the one before", first_unsorted) +
                         "; sorted by time. If the clock started again there, split the file");
  }
  std::size_t doubled = 0, first_doubled = 0;
  const auto same = [&](std::size_t a, std::size_t b) {
    if (times[a] != times[b]) return false;
    if (doubled++ == 0) first_doubled = b;
    return true;
  };
  const auto rest = std::unique(clock.rows.begin(), clock.rows.end(), same);
  clock.rows.erase(rest, clock.rows.end());
  if (doubled > 0) {
    clock.done.push_back(rows_text(doubled, " at the time of another", first_doubled) + " (t = " +
                         number_text(times[first_doubled]) + " s); only the first of each is kept");
  }
  clock.changed = !clock.done.empty();
  return clock;
}

bool counts_from_epoch(const std::vector<double>& times) {
  return !times.empty() && times.front() > earliest_epoch;
}

}  // namespace bbsim::scenario
