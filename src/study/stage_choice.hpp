// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Chooses the number of Radau IIA stages from the length of a step.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

namespace bbsim::study {

// Remembers the lengths for which too few stages were not precise enough. Steps of a sampled rig
// recur with the same few lengths.
class StageChoice {
 public:
  static constexpr std::array counts = {4, 6, 8, 9, 10, 12};
  static constexpr std::size_t last = counts.size() - 1;

  // The first of `counts` that is not known to fail for a step of length h (s).
  [[nodiscard]] std::size_t of(double h) const {
    std::size_t choice = 0;
    while (choice < last && h >= failed_[choice]) ++choice;
    return choice;
  }
  // Records that a choice is not precise enough for h.
  void fail(std::size_t choice, double h) { failed_[choice] = std::min(failed_[choice], 0.9 * h); }
  // Lets failed choices be tried again in the long run: slopes are small at first, and their
  // relative errors large.
  void pass(std::size_t choice) {
    if (choice > 0) failed_[choice - 1] *= 1.002;
  }

 private:
  std::array<double, last> failed_ = [] {
    std::array<double, last> lengths{};
    lengths.fill(std::numeric_limits<double>::infinity());
    return lengths;
  }();
};

}  // namespace bbsim::study
