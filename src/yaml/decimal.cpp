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

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

std::size_t skip_digits(std::string_view text, std::size_t at) {
  while (at < text.size() && is_digit(text[at])) ++at;
  return at;
}

std::size_t skip_sign(std::string_view text, std::size_t at) {
  return at < text.size() && (text[at] == '+' || text[at] == '-') ? at + 1 : at;
}

// Larger exponents overflow or underflow with every mantissa that a file of bounded size can hold.
constexpr long exponent_limit = 100'000'000;

long exponent_value(std::string_view text) {
  if (text.empty()) return 0;
  const bool negative = text.front() == '-';
  if (text.front() == '+') text.remove_prefix(1);
  long value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc{}) return negative ? -exponent_limit : exponent_limit;
  return std::clamp(value, -exponent_limit, exponent_limit);
}

// The power of ten just above the decimal mantissa: 2 for 12.3, -1 for 0.012.
long leading_power(std::string_view mantissa) {
  const auto first = static_cast<long>(mantissa.find_first_of("123456789"));
  const auto point = static_cast<long>(std::min(mantissa.find('.'), mantissa.size()));
  return first < point ? point - first : point + 1 - first;
}

}  // namespace

Decimal leading_decimal(std::string_view text) {
  const std::size_t digits = skip_sign(text, 0);
  std::size_t end = skip_digits(text, digits);
  std::size_t count = end - digits;
  if (end < text.size() && text[end] == '.') {
    const std::size_t fraction = skip_digits(text, end + 1);
    count += fraction - end - 1;
    end = fraction;
  }
  if (count == 0) return {};

  const std::size_t begin = text.front() == '+' ? 1 : 0;
  Decimal decimal{text.substr(begin, end - begin), {}, end};
  if (end < text.size() && (text[end] == 'e' || text[end] == 'E')) {
    const std::size_t exponent = skip_sign(text, end + 1);
    const std::size_t exponent_end = skip_digits(text, exponent);
    if (exponent_end > exponent) {
      decimal.exponent = text.substr(end + 1, exponent_end - end - 1);
      decimal.length = exponent_end;
    }
  }
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
  const long exponent = exponent_value(decimal.exponent) + shift;
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
