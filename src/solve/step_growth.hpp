// How long the next step of a collocation may be.
#pragma once

#include <algorithm>
#include <cmath>

namespace bbsim::solve {

inline constexpr double step_safety = 0.9;

// The size of the next step relative to one of so many stages whose error was `error`, in the
// tolerance's weights.
[[nodiscard]] inline double step_growth(double error, int stages, double most = 8) {
  constexpr double least = 0.1;
  if (!(error > 0)) return error == 0 ? most : least;
  return std::clamp(step_safety * std::pow(error, -1.0 / (stages + 1)), least, most);
}

}  // namespace bbsim::solve
