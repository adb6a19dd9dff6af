// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Servos' motions at the nodes of pieces, kept for lengths that come again.
#pragma once

#include <vector>

#include "model/servo/held_motion.hpp"
#include "solve/sampled/kernel.hpp"

namespace bbsim::solve::sampled {

class MotionTables {
 public:
  explicit MotionTables(const Kernels& kernels) : kernels_(kernels) {}

  // Valid until two others were asked for.
  [[nodiscard]] const MotionTable& of(const model::HeldLaw& law, double length);

 private:
  // A rig's pieces have two lengths, unless something cuts them, and a servo moves by two laws: as
  // it is, and with its acceleration given.
  static constexpr std::size_t kept = 12;

  struct Entry {
    model::HeldLaw law;
    double length;
    long used = 0;  // when it was asked for last
    MotionTable table;
  };
  const Kernels& kernels_;
  std::vector<Entry> entries_;
  long asked_ = 0;
};

}  // namespace bbsim::solve::sampled
