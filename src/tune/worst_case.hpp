// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The numbers that are best in the worst of many cases, under requirements.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace bbsim::tune {

using Point = std::vector<double>;  // numbers from 0 to 1

// What a point comes to in one case.
struct CaseScore {
  double objective = 0;        // to be small; infinite if it has no value
  std::vector<double> excess;  // of each requirement, which holds at 0 or less; may be infinite
  // Where a number is infinite: the share of the case that was not reached, from 0 to 1. So of two
  // points that are both bad one is better.
  double missed = 0;
  std::vector<double> numbers{};  // the caller's own

  [[nodiscard]] bool settled() const;
};

// What a point comes to in many cases. Points are compared by `unsettled`, then `excess`, then
// `objective`.
struct Merit {
  double unsettled = 0;            // 0: all numbers below are finite
  double excess = 0;               // the greatest one, or 0
  double objective = 0;            // a quantile, or the greatest
  std::vector<double> excesses{};  // of each requirement, likewise

  [[nodiscard]] bool better_than(const Merit& other) const;
};

// The value that this share of them is at most: all of them for 1.
[[nodiscard]] double quantile_of(std::vector<double> values, double share);
[[nodiscard]] Merit merit_of(const std::vector<CaseScore>& scores, double share);

struct Problem {
  Point start;
  std::size_t cases = 1, requirements = 0;
  double share = 1;  // of the cases, in which each requirement shall hold
  // Scores each of the points in each of these cases: those of the first point first. False if it
  // was interrupted.
  std::function<bool(const std::vector<Point>& points, const std::vector<std::size_t>& cases,
                     std::vector<CaseScore>& scores)>
      evaluate;
  // After each call of it: the share of the work, and the best objective so far.
  std::function<void(double fraction, double objective)> progress = [](double, double) {};
};

struct Found {
  Point best;                               // empty if it was interrupted before anything was known
  std::vector<CaseScore> at_start, scores;  // of `start` and `best`, in all cases
  Merit merit;
  std::size_t tried = 0;  // points
  bool interrupted = false;
};

// The same input gives the same result.
[[nodiscard]] Found minimize(const Problem& problem);

}  // namespace bbsim::tune
