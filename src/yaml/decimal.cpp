// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "yaml/decimal.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>

namespace bbsim::yaml {
namespace {

// Larger exponents overflow or underflow with every mantissa that a file of bounded size can hold.
constexpr long exponent_limit = 100'000'000;

// The power of ten just above the decimal mantissa: 2 for 12.3, -1 for 0.012.
long leading_power(std::string_view mantissa) {
  const auto first = static_cast<long>(mantissa.find_first_of("123456789"));
  const auto point = static_cast<long>(std::min(mantissa.find('.'), mantissa.size()));
  return first < point ? point - first : point + 1 - first;
}

}  // namespace

Decimal leading_decimal(std::string_view text) {
  // from_chars takes no plus sign, and reads words such as "inf", too.
  const bool plus = text.starts_with('+');
  const std::string_view digits = text.substr(plus || text.starts_with('-') ? 1 : 0);
  if (digits.find_first_of("0123456789.") != 0) return {};
  const char *const begin = text.data() + (plus ? 1 : 0), *const end = text.data() + text.size();
  double value = 0;
  const auto [point, error] = std::from_chars(begin, end, value, std::chars_format::fixed);
  if (error == std::errc::invalid_argument) return {};
  const char* const last = std::from_chars(begin, end, value).ptr;

  Decimal decimal{{begin, static_cast<std::size_t>(point - begin)},
                  0,
                  static_cast<std::size_t>(last - text.data())};
  if (last == point) return decimal;
  const char* const exponent = point + (point[1] == '+' ? 2 : 1);
  if (std::from_chars(exponent, last, decimal.exponent).ec != std::errc{}) {
    decimal.exponent = *exponent == '-' ? -exponent_limit : exponent_limit;
  }
  decimal.exponent = std::clamp(decimal.exponent, -exponent_limit, exponent_limit);
  return decimal;
}

Magnitude magnitude_of(double value, bool zero) {
  if (!std::isfinite(value)) return Magnitude::too_large;
  const bool lossy = std::abs(value) < std::numeric_limits<double>::min();
  return lossy && !zero ? Magnitude::too_small : Magnitude::fine;
}

DecimalValue to_double(const Decimal& decimal, int shift) {
  if (decimal.mantissa.find_first_of("123456789") == std::string_view::npos) {
    return {decimal.mantissa.front() == '-' ? -0.0 : 0.0, Magnitude::fine};
  }
  const long exponent = decimal.exponent + shift;
  const std::string text = std::string(decimal.mantissa) + 'e' + std::to_string(exponent);
  double value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec == std::errc::result_out_of_range) {
    const bool large = exponent + leading_power(decimal.mantissa) > 0;
    return {0, large ? Magnitude::too_large : Magnitude::too_small};
  }
  return {value, magnitude_of(value, false)};
}

}  // namespace bbsim::yaml
