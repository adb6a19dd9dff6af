// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What C++20 has and emscripten 3.1.6's standard library (libc++ 13) lacks: algorithms on ranges,
// std::bit_cast, numbers from and to text, allocation without zeros, and threads that join. Every
// source of the engine includes it first. It has what the sources use, not more.
#pragma once

#include <fast_float/fast_float.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <iterator>
#include <memory>
#include <ranges>
#include <string_view>
#include <system_error>
#include <thread>
#include <type_traits>
#include <utility>

#if _LIBCPP_VERSION >= 16000
#error "This standard library has std::ranges: compile without libcxx.hpp"
#endif

namespace std {

template <class To, class From>
constexpr To bit_cast(const From& from) noexcept {
  static_assert(sizeof(To) == sizeof(From));
  return __builtin_bit_cast(To, from);
}

template <class Array>
unique_ptr<Array> make_unique_for_overwrite(size_t size) {
  return unique_ptr<Array>(new remove_extent_t<Array>[size]);
}

// Numbers in decimal. fast_float reads like from_chars(): no plus sign, no blanks.
inline from_chars_result from_chars(const char* first, const char* last, double& value,
                                    chars_format format) {
  const auto its = format == chars_format::fixed ? fast_float::chars_format::fixed
                                                 : fast_float::chars_format::general;
  const auto read = fast_float::from_chars(first, last, value, its);
  // from_chars() reports numbers beyond the range of a double; fast_float 3 makes them 0 or inf.
  if (read.ec == errc{} && (value == 0 || isinf(value))) {
    const string_view text(first, read.ptr - first);
    const bool is_word = text.find_first_of("iI") != string_view::npos;
    const string_view digits = text.substr(0, text.find_first_of("eE"));
    if (!is_word && digits.find_first_of("123456789") != string_view::npos) {
      return {read.ptr, errc::result_out_of_range};
    }
  }
  return {read.ptr, read.ec};
}

inline from_chars_result from_chars(const char* first, const char* last, double& value) {
  return from_chars(first, last, value, chars_format::general);
}

// The shortest text that reads back to the same double, as to_chars() writes it: fixed, unless
// scientific is shorter.
inline to_chars_result to_chars(char* first, char* last, double value) {
  char digits[32];
  int precision = 0;
  do {
    snprintf(digits, sizeof digits, "%.*e", precision, value);
  } while (precision++ < 16 && strtod(digits, nullptr) != value);
  string_view text = digits;
  char fixed[400];
  if (const char* const mark = strchr(digits, 'e')) {
    const int exponent = atoi(mark + 1);
    const int decimals = max(0, precision - 1 - exponent);
    if (exponent < 17 && exponent > -7) {
      snprintf(fixed, sizeof fixed, "%.*f", decimals, value);
      if (strlen(fixed) <= text.size()) text = fixed;
    }
  }
  if (static_cast<size_t>(last - first) < text.size()) return {last, errc::value_too_large};
  memcpy(first, text.data(), text.size());
  return {first + text.size(), errc{}};
}

// Without threads, constructing one throws; a sweep then computes on its own.
class jthread : public thread {
 public:
  using thread::thread;
  jthread(jthread&&) noexcept = default;
  ~jthread() {
    if (joinable()) join();
  }
};

namespace ranges {

template <class In, class Out>
struct in_out_result {
  In in;
  Out out;
};
template <class Value>
struct min_max_result {
  Value min, max;
};

template <class Range, class Test, class Part = identity>
constexpr auto find_if(Range&& range, Test test, Part part = {}) {
  auto at = std::begin(range);
  for (const auto end = std::end(range); at != end; ++at) {
    if (invoke(test, invoke(part, *at))) break;
  }
  return at;
}
template <class Range, class Test, class Part = identity>
constexpr auto find_if_not(Range&& range, Test test, Part part = {}) {
  return ranges::find_if(
      range, [&](const auto& value) { return !invoke(test, value); }, part);
}
template <class Range, class Value, class Part = identity>
constexpr auto find(Range&& range, const Value& value, Part part = {}) {
  return ranges::find_if(
      range, [&](const auto& one) { return one == value; }, part);
}
template <class Range, class Test, class Part = identity>
constexpr bool any_of(Range&& range, Test test, Part part = {}) {
  return ranges::find_if(range, test, part) != std::end(range);
}
template <class Range, class Test, class Part = identity>
constexpr bool all_of(Range&& range, Test test, Part part = {}) {
  return ranges::find_if_not(range, test, part) == std::end(range);
}
template <class Range, class Test, class Part = identity>
constexpr bool none_of(Range&& range, Test test, Part part = {}) {
  return ranges::find_if(range, test, part) == std::end(range);
}
template <class Range, class Test, class Part = identity>
constexpr auto count_if(Range&& range, Test test, Part part = {}) {
  return std::count_if(std::begin(range), std::end(range),
                       [&](const auto& one) { return invoke(test, invoke(part, one)); });
}
template <class Range, class Value, class Part = identity>
constexpr auto count(Range&& range, const Value& value, Part part = {}) {
  return ranges::count_if(
      range, [&](const auto& one) { return one == value; }, part);
}
template <class Range, class Do>
constexpr void for_each(Range&& range, Do what) {
  std::for_each(std::begin(range), std::end(range), ref(what));
}
template <class Range, class Out>
constexpr auto copy(Range&& range, Out out) {
  const auto end = std::copy(std::begin(range), std::end(range), out);
  return in_out_result<decltype(std::end(range)), decltype(end)>{std::end(range), end};
}
template <class Range, class Out, class Test>
constexpr void copy_if(Range&& range, Out out, Test test) {
  std::copy_if(std::begin(range), std::end(range), out,
               [&](const auto& one) { return invoke(test, one); });
}
template <class Range, class Out>
constexpr void move(Range&& range, Out out) {
  std::move(std::begin(range), std::end(range), out);
}
template <class Range, class Out, class Make>
constexpr void transform(Range&& range, Out out, Make make) {
  std::transform(std::begin(range), std::end(range), out,
                 [&](auto&& one) -> decltype(auto) { return invoke(make, one); });
}
template <class Range, class Value>
constexpr void fill(Range&& range, const Value& value) {
  std::fill(std::begin(range), std::end(range), value);
}
template <class Range, class Value>
constexpr void replace(Range&& range, const Value& from, const Value& to) {
  std::replace(std::begin(range), std::end(range), from, to);
}
template <class Range, class Less = less, class Part = identity>
constexpr void sort(Range&& range, Less less = {}, Part part = {}) {
  std::sort(std::begin(range), std::end(range), [&](const auto& a, const auto& b) {
    return invoke(less, invoke(part, a), invoke(part, b));
  });
}
template <class Range, class Less = less, class Part = identity>
void stable_sort(Range&& range, Less less = {}, Part part = {}) {
  std::stable_sort(std::begin(range), std::end(range), [&](const auto& a, const auto& b) {
    return invoke(less, invoke(part, a), invoke(part, b));
  });
}
template <class Range, class Less = less>
constexpr bool is_sorted(Range&& range, Less less = {}) {
  return std::is_sorted(std::begin(range), std::end(range), less);
}
template <class Range, class Place>
constexpr void nth_element(Range&& range, Place place) {
  std::nth_element(std::begin(range), place, std::end(range));
}
template <class Range, class Value, class Less = less, class Part = identity>
constexpr auto lower_bound(Range&& range, const Value& value, Less less = {}, Part part = {}) {
  return std::lower_bound(
      std::begin(range), std::end(range), value,
      [&](const auto& one, const auto& other) { return invoke(less, invoke(part, one), other); });
}
template <class Range, class Value, class Less = less, class Part = identity>
constexpr auto upper_bound(Range&& range, const Value& value, Less less = {}, Part part = {}) {
  return std::upper_bound(
      std::begin(range), std::end(range), value,
      [&](const auto& other, const auto& one) { return invoke(less, other, invoke(part, one)); });
}
template <class Range, class Same = equal_to, class Part = identity>
constexpr auto adjacent_find(Range&& range, Same same = {}, Part part = {}) {
  return std::adjacent_find(std::begin(range), std::end(range), [&](const auto& a, const auto& b) {
    return invoke(same, invoke(part, a), invoke(part, b));
  });
}
template <class Range, class Other, class Same = equal_to, class Part = identity,
          class OtherPart = identity>
constexpr bool equal(Range&& range, Other&& other, Same same = {}, Part part = {},
                     OtherPart other_part = {}) {
  return std::equal(std::begin(range), std::end(range), std::begin(other), std::end(other),
                    [&](const auto& a, const auto& b) {
                      return invoke(same, invoke(part, a), invoke(other_part, b));
                    });
}
template <class Range>
constexpr auto max(Range&& range) {
  return *std::max_element(std::begin(range), std::end(range));
}
template <class Range>
constexpr auto minmax(Range&& range) {
  const auto [least, greatest] = std::minmax_element(std::begin(range), std::end(range));
  return min_max_result<remove_cvref_t<decltype(*least)>>{*least, *greatest};
}

}  // namespace ranges
}  // namespace std
