// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Picks a few cases from all over a sweep, to learn about the others.
#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>

namespace bbsim::sweep {

// Case i of the sample. Multiples of the golden ratio do not fall into step with a grid's keys.
[[nodiscard]] inline std::size_t sample_case(int i, std::size_t cases) {
  const double whole = i / std::numbers::phi, part = whole - std::floor(whole);
  return static_cast<std::size_t>(part * static_cast<double>(cases));
}

}  // namespace bbsim::sweep
