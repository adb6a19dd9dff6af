// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Compares sets of eigenvalues, whose order may differ.
#pragma once

#include <algorithm>
#include <cmath>

#include "catch.hpp"
#include "model/eigenvalues.hpp"

namespace bbsim_test {

// Largest distance from a value to the nearest of the others, each used once, relative to
// `unit` + its magnitude.
inline double distance(const bbsim::model::Eigenvalues& values, bbsim::model::Eigenvalues others,
                       double unit = 1) {
  REQUIRE(values.size() == others.size());
  double worst = 0;
  for (const auto& value : values) {
    const auto nearest = std::ranges::min_element(
        others, {}, [&](const auto& other) { return std::abs(other - value); });
    worst = std::max(worst, std::abs(*nearest - value) / (unit + std::abs(*nearest)));
    others.erase(nearest);
  }
  return worst;
}

}  // namespace bbsim_test
