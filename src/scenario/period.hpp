// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The rule of keys that are a period.
#pragma once

#include <limits>
#include <string>
#include <string_view>

#include "yaml/quantity.hpp"
#include "yaml/rules.hpp"

namespace bbsim::scenario {

inline constexpr std::string_view period_example = "0.02, \"20 ms\" or \"30 Hz\"";

// A period, or a number per second: "30 Hz".
struct Period {
  yaml::Usual time;

  [[nodiscard]] std::string allowed() const { return time.allowed(); }
  [[nodiscard]] yaml::Declared declared() const {
    return yaml::Declared::any(
        {time.declared(), yaml::Declared::number(yaml::Dimension::angular_rate, {.above = 0})});
  }
  bool read(const yaml::Value& value, double& into) const {
    if (value.node->kind != yaml::Node::Kind::scalar) return time.read(value, into);
    std::string_view text = value.node->text;
    if (!text.ends_with("Hz")) return time.read(value, into);
    text.remove_suffix(2);
    const bool kilo = text.ends_with('k');
    if (kilo) text.remove_suffix(1);
    while (text.ends_with(' ')) text.remove_suffix(1);
    const double rate = yaml::read_quantity(text, false, yaml::Dimension::number).value.value_or(0);
    if (!(rate > 0 && rate < std::numeric_limits<double>::infinity())) {
      return value.refuse("", allowed());
    }
    into = 1 / (kilo ? 1e3 * rate : rate);
    return true;
  }
};

}  // namespace bbsim::scenario
