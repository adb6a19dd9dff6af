// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The part of a run's time that a measure is of.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "base/instant.hpp"

namespace bbsim::scenario {

// From the start of the run on, or to its end, where there is no bound.
struct Window {
  std::optional<double> from{}, to{};  // s

  [[nodiscard]] bool is_whole() const { return !from && !to; }
  [[nodiscard]] double begin() const {
    return from.value_or(-std::numeric_limits<double>::infinity());
  }
  [[nodiscard]] double end() const { return to.value_or(std::numeric_limits<double>::infinity()); }
  // Times nearer than rounding are one.
  [[nodiscard]] bool holds(double t) const {
    return (!from || t >= *from - rounding_of(*from)) && (!to || t <= *to + rounding_of(*to));
  }

  friend bool operator==(const Window&, const Window&) = default;
};

// A name that ends with "from TIME", "to TIME" or both: what stands before, and the window with its
// text as given. A name that does not is of the whole run.
struct WindowedName {
  std::string_view base;
  Window window{};
  std::string_view text{};
};
[[nodiscard]] WindowedName split_window(std::string_view name);

// Why a run from `start` to `end` (s) has no such part, "the window is empty; allowed: ...";
// nothing if it has.
[[nodiscard]] std::string window_fault(const Window& window, double start, double end);

}  // namespace bbsim::scenario
