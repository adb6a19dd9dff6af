// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Conditional integration at a limit (docs/explanation/rig-model.md, (M64) and (M65)): which way a
// command goes on, whose integral part waits while it is at its limit and the error drives it
// outward.
#pragma once

#include <algorithm>

namespace bbsim::model {

// Where a limited quantity u = w + q is; q is its integral part.
enum class AtLimit {
  within,  // u is free, and so is q
  beyond,  // u is cut off; q waits, or comes back where the error drives it inward
  along    // u stays at the limit, and q moves as that needs: Filippov's sliding mode
};

// What moves such a quantity, both positive outward, in its unit per second.
struct OutwardRate {
  double waiting = 0;  // while q waits: w', less the rate of the limit
  double push = 0;     // what the error adds to it while q integrates: K_I e

  // Just within the limit q integrates, just beyond it only inward.
  [[nodiscard]] double within() const { return waiting + push; }
  [[nodiscard]] double beyond() const { return waiting + std::min(push, 0.0); }
  // Of a quantity whose two limits are one, on the other side of it: it waits there, too.
  [[nodiscard]] double beyond_other() const { return waiting + std::max(push, 0.0); }

  // How a quantity goes on that is exactly at its limit; `inner`: within(), or beyond_other().
  [[nodiscard]] AtLimit at_limit(double inner) const {
    if (!(inner > 0)) return AtLimit::within;
    return beyond() < 0 ? AtLimit::along : AtLimit::beyond;
  }
  [[nodiscard]] AtLimit at_limit() const { return at_limit(within()); }
};

}  // namespace bbsim::model
