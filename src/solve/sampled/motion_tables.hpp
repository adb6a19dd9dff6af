// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Caches the motions of servos at the nodes of pieces, for piece lengths that recur.
#pragma once

#include <vector>

#include "model/servo/held_motion.hpp"
#include "solve/sampled/kernel.hpp"

namespace bbsim::solve::sampled {

class MotionTables {
 public:
  explicit MotionTables(const Kernels& kernels) : kernels_(kernels) {}

  // The table of a law for pieces of `length` s. Valid until two other tables are requested.
  [[nodiscard]] const MotionTable& of(const model::HeldLaw& law, double length);

 private:
  // Uncut pieces of a rig have two lengths. A servo has two laws: free, and with its acceleration
  // given.
  static constexpr std::size_t kept = 12;

  struct Entry {
    model::HeldLaw law;
    double length;
    long used = 0;  // the last request
    MotionTable table;
  };
  const Kernels& kernels_;
  std::vector<Entry> entries_;
  long asked_ = 0;
};

}  // namespace bbsim::solve::sampled
