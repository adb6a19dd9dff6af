// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The decimal number at the front of a text, and its double.
#pragma once

#include <cstddef>
#include <string_view>

namespace bbsim::yaml {

// [+-] digits [. digits] [e [+-] digits], with a digit on at least one side of the point.
struct Decimal {
  std::string_view mantissa;  // with its minus sign, without a plus sign
  std::string_view exponent;  // after the e; empty if there is none
  std::size_t length = 0;     // of the whole number in the text; 0 if the text starts with none
};

[[nodiscard]] Decimal leading_decimal(std::string_view text);

enum class Magnitude { fine, too_large, too_small };

// Too large for a double, or so small that a double would lose digits (a denormal) or be zero.
struct DecimalValue {
  double value = 0;
  Magnitude magnitude = Magnitude::fine;
};

// The double nearest to decimal * 10^shift.
[[nodiscard]] DecimalValue to_double(const Decimal& decimal, int shift);

// Whether a double of this value is a full-precision one.
[[nodiscard]] Magnitude magnitude_of(double value, bool zero);

}  // namespace bbsim::yaml
