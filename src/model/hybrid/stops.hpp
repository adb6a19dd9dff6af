// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The stops of the input: times at which the input or one of its derivatives jumps.
#pragma once

#include "model/hybrid/part.hpp"

namespace bbsim::model {

class Stops : public Part {
 public:
  explicit Stops(const std::vector<double>& times) : times_(times) { put(); }

  [[nodiscard]] double next_time() const { return time_; }
  [[nodiscard]] double next_change() const { return time_; }
  void observe(double t, const double* /*z*/) {
    while (time_ <= t) {
      ++next_;
      put();
    }
  }

 private:
  void put() { time_ = next_ < times_.size() ? times_[next_] : unlimited; }

  const std::vector<double>& times_;
  std::size_t next_ = 0;
  double time_ = unlimited;  // the next stop, s
};

}  // namespace bbsim::model
