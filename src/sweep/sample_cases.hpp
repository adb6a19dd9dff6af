// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A few cases from all over a sweep, to learn what the others are like.
#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>

namespace bbsim::sweep {

// The i-th of them: at multiples of the golden ratio, which no grid has in step with its keys.
[[nodiscard]] inline std::size_t sample_case(int i, std::size_t cases) {
  const double whole = i / std::numbers::phi, part = whole - std::floor(whole);
  return static_cast<std::size_t>(part * static_cast<double>(cases));
}

}  // namespace bbsim::sweep
