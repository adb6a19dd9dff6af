// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Gathers rows and passes them to a sink in blocks.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>

#include "solve/outcome.hpp"

namespace bbsim::solve {

class RowBlock {
 public:
  // `capacity`: the number of rows in a block.
  RowBlock(StateSink& sink, std::size_t row_size, std::size_t capacity = 256)
      : sink_(sink),
        row_size_(row_size),
        capacity_(capacity),
        values_(std::make_unique_for_overwrite<double[]>(row_size * capacity)) {}

  // Returns space for the next row. The row must be complete before the next call of next() or
  // flush().
  [[nodiscard]] double* next() {
    if (count_ == capacity_) flush();
    return values_.get() + row_size_ * count_++;
  }

  // Returns space for several adjacent rows. Reduces `wanted` to the number of rows that fit.
  [[nodiscard]] double* next(std::size_t& wanted) {
    if (count_ == capacity_) flush();
    wanted = std::min(wanted, capacity_ - count_);
    double* const first = values_.get() + row_size_ * count_;
    count_ += wanted;
    return first;
  }

  // Leaves out the next rows.
  void skip(std::size_t count) {
    flush();
    first_ += count;
  }

  void flush() {
    if (count_ > 0) sink_.accept(first_, count_, values_.get());
    first_ += count_;
    count_ = 0;
  }

  [[nodiscard]] std::size_t rows() const { return first_ + count_; }

 private:
  StateSink& sink_;
  std::size_t row_size_, capacity_;
  std::unique_ptr<double[]> values_;
  std::size_t first_ = 0, count_ = 0;
};

}  // namespace bbsim::solve
