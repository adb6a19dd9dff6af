// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A key that a fit or an optimizer may choose, as a number u without bounds or unit.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/columns.hpp"
#include "scenario/family.hpp"

namespace bbsim::fit {

inline constexpr double unlimited = std::numeric_limits<double>::infinity();

// The number u of a key is 0 at its value before the fit. The value is start exp(u) if it must be
// positive, otherwise start + scale u. Differences and covariances then have size 1.
struct FreeKey {
  // Owner of the key: the scenario, or a sensor, whose log shows offset + scale column(t - delay).
  enum class Of { scenario, scale, offset, delay };

  std::string name;
  std::string unit;  // SI; empty for a number
  double start = 0;
  double lower, upper;  // bounds of the value
  bool logarithmic = false;
  double scale = 1;
  Of of = Of::scenario;
  std::size_t column = 0;  // index of the compared column, for a scale or an offset

  [[nodiscard]] double value(double u) const;  // within the bounds
  [[nodiscard]] double number(double value) const;
  // Derivative of the value by u.
  [[nodiscard]] double slope(double u) const;
  [[nodiscard]] ScenarioFamily::Setting setting(double value) const;
};

// Reads KEY or KEY=FROM:TO of --free. Throws InputError.
[[nodiscard]] FreeKey read_free_key(std::string_view text, const ScenarioFamily& family);

// Whether `text` is log.COLUMN.scale, log.COLUMN.offset or log.delay, with or without bounds.
[[nodiscard]] bool is_of_log(std::string_view text);
// Reads such a key for a fit that compares `columns`. Throws InputError.
[[nodiscard]] FreeKey read_log_key(std::string_view text,
                                   const std::vector<const scenario::Column*>& columns);
// Throws InputError if `keys` already has one with that name.
void add_free_key(std::vector<FreeKey>& keys, FreeKey key);
// Reads the keys of a scenario in `texts` and skips those of a log. Throws InputError for
// duplicates and for keys of a window's start.
[[nodiscard]] std::vector<FreeKey> read_free_keys(const std::vector<std::string>& texts,
                                                  const ScenarioFamily& family);

}  // namespace bbsim::fit
