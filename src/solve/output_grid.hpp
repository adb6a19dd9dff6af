// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The times of the output rows: i * step, exactly, and the end; or a list of times.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "base/instant.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::solve {

class OutputGrid {
 public:
  explicit OutputGrid(const OutputTimes& times) : step_(times.step), end_(times.end) {
    // A multiple of the step within rounding of the end counts as the end.
    const double intervals = end_ / step_;
    const double whole = std::floor(intervals);
    const double slack = std::max(1e-9, rounding_of(intervals));
    before_end_ = static_cast<std::size_t>(intervals - whole > slack ? whole + 1 : whole);
    if (before_end_ == 0) before_end_ = 1;  // t = 0 always has a row
  }

  // These times (s): at least two that increase, the first of them 0.
  explicit OutputGrid(std::vector<double> times)
      : step_(0), end_(times.back()), before_end_(times.size() - 1) {
    times_ = std::make_shared<const std::vector<double>>(std::move(times));
  }

  bool operator==(const OutputGrid& other) const {
    const bool alike = step_ == other.step_ && end_ == other.end_;
    return alike && (times_ && other.times_ ? *times_ == *other.times_ : times_ == other.times_);
  }

  [[nodiscard]] std::size_t size() const { return before_end_ + 1; }
  [[nodiscard]] double end() const { return end_; }

  // The time of row i < size(), s.
  [[nodiscard]] double operator[](std::size_t i) const {
    if (times_) return (*times_)[i];
    // Signed integers convert faster.
    return i < before_end_ ? static_cast<double>(static_cast<std::ptrdiff_t>(i)) * step_ : end_;
  }

  // The number of rows at or before `time` >= 0, s.
  [[nodiscard]] std::size_t rows_until(double time) const {
    if (time >= end_) return size();
    if (times_) {
      const auto after = std::upper_bound(times_->begin(), times_->end(), time);
      return static_cast<std::size_t>(after - times_->begin());
    }
    std::size_t rows = static_cast<std::size_t>(time / step_) + 1;  // within one, by rounding
    while (rows > 0 && (*this)[rows - 1] > time) --rows;
    while ((*this)[rows] <= time) ++rows;
    return rows;
  }

 private:
  double step_, end_;
  std::size_t before_end_;
  std::shared_ptr<const std::vector<double>> times_;  // of a list
};

}  // namespace bbsim::solve
