// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The time window of a measure.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "base/instant.hpp"

namespace bbsim::scenario {

// A missing bound means the start or the end of the run.
struct Window {
  std::optional<double> from{}, to{};  // s

  [[nodiscard]] bool is_whole() const { return !from && !to; }
  [[nodiscard]] double begin() const {
    return from.value_or(-std::numeric_limits<double>::infinity());
  }
  [[nodiscard]] double end() const { return to.value_or(std::numeric_limits<double>::infinity()); }
  // Times within rounding of a bound belong to the window.
  [[nodiscard]] bool holds(double t) const {
    return (!from || t >= *from - rounding_of(*from)) && (!to || t <= *to + rounding_of(*to));
  }

  friend bool operator==(const Window&, const Window&) = default;
};

// Splits a name that ends in "from TIME", "to TIME" or both into the rest, the window, and the
// window's text. Other names have the whole run as their window.
struct WindowedName {
  std::string_view base;
  Window window{};
  std::string_view text{};
};
[[nodiscard]] WindowedName split_window(std::string_view name);

// Why the window does not fit a run from `start` to `end` (s): "the window is empty; allowed: ...".
// Empty if it fits.
[[nodiscard]] std::string window_fault(const Window& window, double start, double end);

}  // namespace bbsim::scenario
