// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// First in, first out, of a few: mostly without a move of what is left, and without more memory
// once it has held as many.
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
  // One more, to be filled.
  T& push() {
    // Those that are gone make room before there are more of them than of the others.
    if (first_ > 8 && 2 * first_ > all_.size()) {
      all_.erase(all_.begin(), all_.begin() + static_cast<std::ptrdiff_t>(first_));
      first_ = 0;
    }
    return all_.emplace_back();
  }
  // Of a queue that is not empty.
  T pop() {
    T one = all_[first_++];
    if (empty()) {
      all_.clear();
      first_ = 0;
    }
    return one;
  }

  // base/archive.hpp
  template <class Archive>
  void archive(Archive& archive) {
    archive(all_, first_);
    archive.require(first_ < all_.size() || (first_ == 0 && all_.empty()));
  }

 private:
  std::vector<T> all_;
  std::size_t first_ = 0;
};

}  // namespace bbsim
