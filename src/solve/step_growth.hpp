// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// How long the next step of a collocation may be.
#pragma once

#include <algorithm>
#include <cmath>

namespace bbsim::solve {

inline constexpr double step_safety = 0.9;

// The size of the next step relative to one of so many stages whose error was `error`, in the
// tolerance's weights. Single precision will do, and is faster.
template <class Real>
[[nodiscard]] inline double step_growth(Real error, int stages, double most = 8) {
  constexpr double least = 0.1;
  if (!(error > 0)) return error == 0 ? most : least;
  const auto power = static_cast<Real>(-1.0 / (stages + 1));
  return std::clamp(step_safety * double{std::pow(error, power)}, least, most);
}

}  // namespace bbsim::solve
