// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A key that a fit or an optimizer is free to choose; to a fit, a number without bounds or unit.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/columns.hpp"
#include "scenario/family.hpp"

namespace bbsim::fit {

// The number u of a key is 0 at its value before the fit. A key that must be positive is
// value = start exp(u); any other, start + scale u. So differences and covariances are of size 1.
struct FreeKey {
  // What it belongs to: the scenario, or a sensor, of which a log shows
  // offset + scale column(t - delay).
  enum class Of { scenario, scale, offset, delay };

  std::string name;
  std::string unit;  // SI; empty for a number
  double start = 0;
  double lower, upper;  // bounds of the value
  bool logarithmic = false;
  double scale = 1;
  Of of = Of::scenario;
  std::size_t column = 0;  // of the compared ones, for a scale or an offset

  [[nodiscard]] double value(double u) const;  // within the bounds
  [[nodiscard]] double number(double value) const;
  // The derivative of the value.
  [[nodiscard]] double slope(double u) const;
  [[nodiscard]] ScenarioFamily::Setting setting(double value) const;
};

// Reads KEY or KEY=FROM:TO of --free. Throws InputError.
[[nodiscard]] FreeKey read_free_key(std::string_view text, const ScenarioFamily& family);

// Whether `text` is log.COLUMN.scale, log.COLUMN.offset or log.delay, with bounds or without.
[[nodiscard]] bool is_of_log(std::string_view text);
// Reads it, for a fit that compares `columns`. Throws InputError.
[[nodiscard]] FreeKey read_log_key(std::string_view text,
                                   const std::vector<const scenario::Column*>& columns);
// Throws InputError where `keys` has one of that name.
void add_free_key(std::vector<FreeKey>& keys, FreeKey key);
// The keys of a scenario among `texts`, without those of a log. Throws InputError for a key that is
// there twice, or that is of a window's start.
[[nodiscard]] std::vector<FreeKey> read_free_keys(const std::vector<std::string>& texts,
                                                  const ScenarioFamily& family);

}  // namespace bbsim::fit
