// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Detects rigs that switch again and again without progress.
#pragma once

namespace bbsim::solve {

// A hundred switches in a row without progress in time are a standstill.
class Standstill {
 public:
  // Counts a switch at t (s). Returns whether the rig stands still.
  [[nodiscard]] bool after(double t) {
    const bool still = t - last_ <= 1e-13 * t;
    still_ = still ? still_ + 1 : 0;
    last_ = t;
    return still_ >= most;
  }

 private:
  static constexpr int most = 100;

  double last_ = -1;  // the last switch, s
  int still_ = 0;
};

}  // namespace bbsim::solve
