// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A key that a fit or an optimizer is free to choose; to a fit, a number without bounds or unit.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenario/family.hpp"

namespace bbsim::fit {

// The number u of a key is 0 at its value before the fit. A key that must be positive is
// value = start exp(u); any other, start + scale u. So differences and covariances are of size 1.
struct FreeKey {
  std::string name;
  std::string unit;  // SI; empty for a number
  double start = 0;
  double lower, upper;  // bounds of the value
  bool logarithmic = false;
  double scale = 1;

  [[nodiscard]] double value(double u) const;  // within the bounds
  [[nodiscard]] double number(double value) const;
  // The derivative of the value.
  [[nodiscard]] double slope(double u) const;
  [[nodiscard]] ScenarioFamily::Setting setting(double value) const;
};

// Reads KEY or KEY=FROM:TO of --free. Throws InputError.
[[nodiscard]] FreeKey read_free_key(std::string_view text, const ScenarioFamily& family);

// Those of a fit, each once, and none that is of a window's start. Throws InputError.
[[nodiscard]] std::vector<FreeKey> read_free_keys(const std::vector<std::string>& texts,
                                                  const ScenarioFamily& family);

}  // namespace bbsim::fit
