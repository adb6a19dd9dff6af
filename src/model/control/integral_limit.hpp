// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Conditional integration at a limit (docs/explanation/rig-model.md, (M64) and (M65)): how a
// command evolves if its integral part waits while the command is at its limit and the error drives
// it outward.
#pragma once

#include <algorithm>

namespace bbsim::model {

// Position of a limited quantity u = w + q; q is its integral part.
enum class AtLimit {
  within,  // u is free, and so is q
  beyond,  // u is cut off; q waits, or moves inward with the error
  along    // u stays at the limit and q moves accordingly: Filippov's sliding mode
};

// Rates of such a quantity, positive outward, in its unit per second.
struct OutwardRate {
  double waiting = 0;  // while q waits: w' minus the rate of the limit
  double push = 0;     // added by the error while q integrates: K_I e

  // Just within the limit q integrates; just beyond it, only inward.
  [[nodiscard]] double within() const { return waiting + push; }
  [[nodiscard]] double beyond() const { return waiting + std::min(push, 0.0); }
  // If both limits are equal, the rate on their other side, where q also integrates only inward.
  [[nodiscard]] double beyond_other() const { return waiting + std::max(push, 0.0); }

  // How a quantity continues from exactly its limit; `inner`: within(), or beyond_other().
  [[nodiscard]] AtLimit at_limit(double inner) const {
    if (!(inner > 0)) return AtLimit::within;
    return beyond() < 0 ? AtLimit::along : AtLimit::beyond;
  }
  [[nodiscard]] AtLimit at_limit() const { return at_limit(within()); }
};

}  // namespace bbsim::model
