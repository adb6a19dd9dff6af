// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Optimizes numbers for the worst of many cases, under requirements.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace bbsim::tune {

using Point = std::vector<double>;  // numbers from 0 to 1

// The result of a point in one case.
struct CaseScore {
  double objective = 0;        // minimized; infinite if it has no value
  std::vector<double> excess;  // one per requirement, met at 0 or less; may be infinite
  // If a number is infinite: the fraction of the case that was not reached, 0 to 1. It ranks points
  // that both fail.
  double missed = 0;
  std::vector<double> numbers{};  // for the caller's use

  [[nodiscard]] bool settled() const;
};

// The result of a point in many cases. Points are compared by `unsettled`, then `excess`, then
// `objective`.
struct Merit {
  double unsettled = 0;            // 0 if all numbers below are finite
  double excess = 0;               // the largest one, at least 0
  double objective = 0;            // a quantile or the maximum over the cases
  std::vector<double> excesses{};  // one per requirement, likewise

  [[nodiscard]] bool better_than(const Merit& other) const;
};

// The quantile of the values: at least this share of them do not exceed it. 1 gives the maximum.
[[nodiscard]] double quantile_of(std::vector<double> values, double share);
[[nodiscard]] Merit merit_of(const std::vector<CaseScore>& scores, double share);

struct Problem {
  Point start;
  std::size_t cases = 1, requirements = 0;
  double share = 1;  // fraction of the cases in which each requirement must hold
  // Scores each point in each of these cases, all cases of the first point first. Returns false if
  // interrupted.
  std::function<bool(const std::vector<Point>& points, const std::vector<std::size_t>& cases,
                     std::vector<CaseScore>& scores)>
      evaluate;
  // Called after each evaluate(), with the fraction done and the best objective so far.
  std::function<void(double fraction, double objective)> progress = [](double, double) {};
};

struct Found {
  Point best;                               // empty if interrupted before the first evaluation
  std::vector<CaseScore> at_start, scores;  // of `start` and `best`, in all cases
  Merit merit;
  std::size_t tried = 0;  // number of points
  bool interrupted = false;
};

// Deterministic: the same input gives the same result.
[[nodiscard]] Found minimize(const Problem& problem);

}  // namespace bbsim::tune
