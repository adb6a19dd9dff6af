// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "base/number_text.hpp"

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string_view>

// Makes fmt use its full table of powers of ten instead of computing most of them for each number.
#define FMT_USE_FULL_CACHE_DRAGONBOX 1
#include <fmt/format.h>

namespace bbsim {
namespace {

char* write_word(char* to, std::string_view word) {
  return to + word.copy(to, word.size());
}

// The most digits in the shortest form of a double.
constexpr int most_digits = 17;

constexpr auto powers_of_ten = [] {
  std::array<std::uint64_t, most_digits> powers{};
  std::uint64_t power = 1;
  for (std::uint64_t& each : powers) {
    each = power;
    power *= 10;
  }
  return powers;
}();

// Writes eight digits, with leading zeros. Works on all digits at once: splits the number into two
// halves of 32 bits, these into quarters of 16 bits, and these into digits of 8 bits.
void write_eight(char* to, std::uint64_t number) {
  if constexpr (std::endian::native == std::endian::little) {
    const std::uint64_t half = number / 10000;
    const std::uint64_t halves = half | (number - 10000 * half) << 32U;
    const std::uint64_t quarter = (halves * 5243 >> 19U) & 0x0000007F'0000007FU;
    const std::uint64_t quarters = quarter | (halves - 100 * quarter) << 16U;
    const std::uint64_t ten = (quarters * 103 >> 10U) & 0x000F'000F'000F'000FU;
    const std::uint64_t digits = ten | (quarters - 10 * ten) << 8U;
    const std::uint64_t text = digits + 0x3030'3030'3030'3030U;
    std::memcpy(to, &text, sizeof text);
  } else {
    for (int i = 7; i >= 0; --i) {
      to[i] = static_cast<char>('0' + number % 10);
      number /= 10;
    }
  }
}

// Writes most_digits characters, of which the first `count` are `digits`. Returns the end of these.
char* write_digits(char* to, std::uint64_t digits, int count) {
  constexpr std::uint64_t eight = powers_of_ten[8], sixteen = powers_of_ten[16];
  digits *= powers_of_ten[static_cast<std::size_t>(most_digits - count)];
  const std::uint64_t rest = digits % sixteen;
  *to = static_cast<char>('0' + digits / sixteen);
  write_eight(to + 1, rest / eight);
  write_eight(to + 9, rest % eight);
  return to + count;
}

// Writes ddd.ddd with `whole` digits before the point; `count` > `whole` > 0.
char* write_with_point(char* to, std::uint64_t digits, int count, int whole) {
  char* const end = write_digits(to + 1, digits, count);
  for (int i = 0; i < whole; ++i) to[i] = to[i + 1];
  to[whole] = '.';
  return end;
}

// Writes d.ddde+xx; `exponent` belongs to the first digit.
char* write_scientific(char* to, std::uint64_t digits, int count, int exponent) {
  to = count > 1 ? write_with_point(to, digits, count, 1) : write_digits(to, digits, 1);
  *to++ = 'e';
  *to++ = exponent < 0 ? '-' : '+';
  const int size = std::abs(exponent);
  if (size >= 100) *to++ = static_cast<char>('0' + size / 100);
  *to++ = static_cast<char>('0' + size / 10 % 10);
  *to++ = static_cast<char>('0' + size % 10);
  return to;
}

}  // namespace

// The text equals that of std::to_chars, which takes twice as long for the digits of a long number
// and longer still for those of a short one. The shorter notation wins; fixed wins a tie.
char* write_number(char* to, double value) {
  if (std::isnan(value)) return write_word(to, "nan");
  if (std::signbit(value)) {
    *to++ = '-';
    value = -value;
  }
  if (value == 0) return write_word(to, "0");
  if (std::isinf(value)) return write_word(to, "inf");

  const auto [digits, last] = fmt::detail::dragonbox::to_decimal(value);
  const int count = fmt::detail::count_digits(digits);
  const int first = last + count - 1;  // value = d.ddd * 10^first = ddd * 10^last
  const int scientific = count + (count > 1 ? 1 : 0) + (std::abs(first) < 100 ? 4 : 5);
  const int fixed = last >= 0 ? count + last : first >= 0 ? count + 1 : count + 1 - first;
  if (scientific < fixed) return write_scientific(to, digits, count, first);
  if (last > 0) {
    // std::to_chars writes a whole number with all its exact digits. Trailing zeros after the
    // shortest digits would differ.
    return std::to_chars(to, to + longest_number, value).ptr;
  }
  if (last == 0) return write_digits(to, digits, count);
  if (first >= 0) return write_with_point(to, digits, count, first + 1);
  std::memcpy(to, "0.000000", 8);  // longer than any prefix; copies without a branch
  return write_digits(to + 1 - first, digits, count);
}

}  // namespace bbsim
