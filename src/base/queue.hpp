// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A first-in first-out queue for a few elements. It rarely moves elements, and it reuses its
// memory.
#pragma once

#include <cstddef>
#include <vector>

namespace bbsim {

template <class T>
class Queue {
 public:
  [[nodiscard]] bool empty() const { return first_ == all_.size(); }
  [[nodiscard]] std::size_t size() const { return all_.size() - first_; }
  [[nodiscard]] const T& front() const { return all_[first_]; }
  // Appends an element for the caller to fill.
  T& push() {
    // Erases consumed elements once they outnumber the others.
    if (first_ > 8 && 2 * first_ > all_.size()) {
      all_.erase(all_.begin(), all_.begin() + static_cast<std::ptrdiff_t>(first_));
      first_ = 0;
    }
    return all_.emplace_back();
  }
  // The queue must not be empty.
  T pop() {
    T element = all_[first_++];
    if (empty()) {
      all_.clear();
      first_ = 0;
    }
    return element;
  }

 private:
  std::vector<T> all_;
  std::size_t first_ = 0;
};

}  // namespace bbsim
