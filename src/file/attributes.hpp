// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The attributes of a results file.
#pragma once

#include <concepts>
#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/number_text.hpp"

namespace bbsim::file {

// Text or a number.
class AttributeValue {
 public:
  using Variant = std::variant<std::string, double, std::int64_t>;

  AttributeValue(std::string text) : value_(std::move(text)) {}
  AttributeValue(const char* text) : value_(std::string(text)) {}
  AttributeValue(double number) : value_(number) {}
  template <std::integral Integer>
  AttributeValue(Integer number) : value_(static_cast<std::int64_t>(number)) {}

  [[nodiscard]] const Variant& value() const { return value_; }

  // The value as text, with numbers in their shortest form.
  [[nodiscard]] std::string text() const {
    if (const auto* real = std::get_if<double>(&value_)) return number_text(*real);
    if (const auto* whole = std::get_if<std::int64_t>(&value_)) return std::to_string(*whole);
    return std::get<std::string>(value_);
  }

  friend bool operator==(const AttributeValue&, const AttributeValue&) = default;

 private:
  Variant value_;
};

// Root attributes of an HDF5 file, in order. CSV cannot hold them.
using Attributes = std::vector<std::pair<std::string, AttributeValue>>;

}  // namespace bbsim::file
