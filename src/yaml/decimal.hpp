// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads the decimal number at the start of a text as a double.
#pragma once

#include <cstddef>
#include <string_view>

namespace bbsim::yaml {

// [+-] digits [. digits] [e [+-] digits], with a digit on at least one side of the point.
struct Decimal {
  std::string_view mantissa;  // with a minus sign, without a plus sign
  long exponent = 0;          // after the e, within 1e8
  std::size_t length = 0;     // of the number in the text; 0 if the text starts with no number
};

[[nodiscard]] Decimal leading_decimal(std::string_view text);

enum class Magnitude { fine, too_large, too_small };

// `value` is valid only if the magnitude is fine. Too small: a double would lose digits (a
// denormal) or become zero.
struct DecimalValue {
  double value = 0;
  Magnitude magnitude = Magnitude::fine;
};

// The double nearest to decimal * 10^shift.
[[nodiscard]] DecimalValue to_double(const Decimal& decimal, int shift);

// `fine` for a normal double. `zero` says that the exact value is zero, which is also fine.
[[nodiscard]] Magnitude magnitude_of(double value, bool zero);

}  // namespace bbsim::yaml
