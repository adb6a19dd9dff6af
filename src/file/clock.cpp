// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/clock.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/number_text.hpp"
#include "base/text.hpp"

namespace bbsim::file {
namespace {

constexpr double two_to_32 = 4294967296.0;
constexpr double earliest_epoch = 1e8;  // s: 1973 in Unix time, and three years for other clocks

std::string rows_text(std::size_t count, const char* what, std::size_t first) {
  return counted(count, "row") + what + ", first in row " + std::to_string(first + 1);
}

// The first row from which a clock starts again: it falls by most of the time that has passed, and
// goes on from there. Single rows out of order do not count.
std::optional<std::size_t> restart_of(const std::vector<double>& times,
                                      const std::vector<std::size_t>& rows) {
  constexpr std::size_t fewest = 4;  // rows on both sides
  for (std::size_t k = fewest; k + fewest <= rows.size(); ++k) {
    const double begin = times[rows.front()], before = times[rows[k - 1]], now = times[rows[k]];
    if (!(before - now > (before - begin) / 2 && before > begin)) continue;
    bool goes_on = true;
    for (std::size_t i = k + 1; i < k + fewest; ++i) {
      goes_on = goes_on && times[rows[i]] >= times[rows[i - 1]] && times[rows[i]] < before;
    }
    if (goes_on) return rows[k];
  }
  return {};
}

// Reads digits; moves `text` beyond them.
std::optional<int> take_digits(std::string_view& text, std::size_t fewest, std::size_t most) {
  std::size_t count = 0;
  int value = 0;
  while (count < most && count < text.size() && text[count] >= '0' && text[count] <= '9') {
    value = 10 * value + (text[count++] - '0');
  }
  if (count < fewest) return {};
  text.remove_prefix(count);
  return value;
}

bool take_any(std::string_view& text, std::string_view any_of) {
  if (text.empty() || any_of.find(text.front()) == std::string_view::npos) return false;
  text.remove_prefix(1);
  return true;
}

// Days since 1970 of a date; moves `text` beyond it and the character behind it. `american`: the
// month comes before the day.
std::optional<double> take_date(std::string_view& text, bool american) {
  const auto first = take_digits(text, 1, 4);
  if (!first || !take_any(text, "-./")) return {};
  const auto second = take_digits(text, 1, 2);
  if (!second || !take_any(text, "-./")) return {};
  const auto last = take_digits(text, 1, 4);
  if (!last || !take_any(text, " T_")) return {};
  const bool year_first = *first > 31;
  const int month = american && !year_first ? *first : *second;
  const int day = year_first ? *last : american ? *second : *first;
  const std::chrono::year_month_day date{std::chrono::year(year_first ? *first : *last),
                                         std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  if (!date.ok()) return {};
  return static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count());
}

// The half of the day at the end of a text, which loses it: "AM", "pm"; nothing: 24 hours.
enum class Half { none, morning, afternoon };
Half take_half(std::string_view& text) {
  if (text.size() < 3 || (text.back() != 'M' && text.back() != 'm')) return Half::none;
  const char letter = text[text.size() - 2];
  const bool morning = letter == 'A' || letter == 'a';
  if (!morning && letter != 'P' && letter != 'p') return Half::none;
  text = trimmed(text.substr(0, text.size() - 2));
  return morning ? Half::morning : Half::afternoon;
}

constexpr double day = 86400;  // s

// Seconds since 1970, or since midnight.
std::optional<double> seconds_of_stamp(std::string_view text) {
  double whole = 0;
  const Half half = take_half(text);
  if (text.find_first_of(" T_") != std::string_view::npos) {
    const auto days = take_date(text, half != Half::none && text.find('/') != text.npos);
    if (!days) return {};
    whole = *days * day;
  }
  auto hours = take_digits(text, 1, 2);
  if (!hours || *hours > 24 || !take_any(text, ":")) return {};
  if (half != Half::none) {
    if (*hours < 1 || *hours > 12) return {};
    hours = *hours % 12 + (half == Half::afternoon ? 12 : 0);
  }
  const auto minutes = take_digits(text, 2, 2);
  if (!minutes || *minutes > 59) return {};
  double seconds = 0;
  if (take_any(text, ":")) {
    const auto count = take_digits(text, 2, 2);
    if (!count || *count > 60) return {};
    seconds = *count;
    if (take_any(text, ".,:")) {
      const std::size_t digits = text.size();
      const auto part = take_digits(text, 1, 9);
      if (!part) return {};
      seconds += *part / std::pow(10, static_cast<double>(digits - text.size()));
    }
  }
  // A zone is the same in all rows.
  if (!text.empty() && text.find_first_not_of("Z+-:0123456789") != std::string_view::npos)
    return {};
  return whole + 3600.0 * *hours + 60.0 * *minutes + seconds;
}

}  // namespace

std::optional<std::string> read_stamps(Column& column) {
  if (!column.is_text()) return {};
  std::vector<double> times(column.numbers.size(), std::nan(""));
  std::optional<double> first;
  double before = 0, added = 0;
  for (std::size_t row = 0; row < times.size(); ++row) {
    if (column.has_text(row) && column.texts[row].empty()) continue;
    const std::optional<double> stamp = seconds_of_stamp(trimmed(column.text(row)));
    if (!stamp) return {};
    if (!first) first = before = *stamp;
    if (*stamp < day && before - *stamp > day / 2) added += day;
    before = *stamp;
    times[row] = *stamp + added - *first;
  }
  column.numbers = std::move(times);
  column.texts.assign(column.numbers.size(), "");  // a missing time stays missing
  return "its times are dates or times of day; the first row is t = 0";
}

std::optional<std::string> unwrap(std::vector<double>& times) {
  const auto is_counter = [](double t) { return std::abs(t) <= two_to_32 && t == std::trunc(t); };
  double added = 0, before = std::nan("");
  std::size_t wraps = 0, first = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double t = times[i];
    if (std::isnan(t)) continue;
    if (is_counter(t) && is_counter(before) && before - t > two_to_32 / 2) {
      added += two_to_32;
      if (wraps++ == 0) first = i;
    }
    before = t;
    times[i] += added;
  }
  if (wraps == 0) return {};
  return "its clock of 32 bits wraps " +
         (wraps == 1 ? std::string("once") : std::to_string(wraps) + " times") + ", first in row " +
         std::to_string(first + 1) + "; 2^32 is added from there on";
}

Clock clock_of(const std::vector<double>& times) {
  Clock clock;
  std::size_t without = 0, first_without = 0, unsorted = 0, first_unsorted = 0;
  double latest = -INFINITY;
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!std::isfinite(times[i])) {
      if (without++ == 0) first_without = i;
      continue;
    }
    if (times[i] < latest && unsorted++ == 0) first_unsorted = i;
    latest = std::max(latest, times[i]);
    clock.rows.push_back(i);
  }
  clock.restart = restart_of(times, clock.rows);
  if (clock.restart) {
    clock.rows.clear();
    return clock;
  }
  if (without > 0) {
    clock.done.push_back(rows_text(without, " without a time", first_without) + "; left out");
  }
  if (unsorted > 0) {
    std::ranges::stable_sort(clock.rows, {}, [&](std::size_t row) { return times[row]; });
    clock.done.push_back(rows_text(unsorted, " earlier than the one before", first_unsorted) +
                         "; sorted by time");
  }
  std::size_t doubled = 0, first_doubled = 0;
  const auto same = [&](std::size_t a, std::size_t b) {
    if (times[a] != times[b]) return false;
    if (doubled++ == 0) first_doubled = b;
    return true;
  };
  const auto rest = std::unique(clock.rows.begin(), clock.rows.end(), same);
  clock.rows.erase(rest, clock.rows.end());
  if (doubled > 0) {
    clock.done.push_back(rows_text(doubled, " at the time of another", first_doubled) + " (t = " +
                         number_text(times[first_doubled]) + " s); only the first of each is kept");
  }
  return clock;
}

std::string_view unit_since_epoch(const std::vector<double>& times) {
  const auto first = std::ranges::find_if(times, [](double t) { return std::isfinite(t); });
  if (first == times.end()) return {};
  const double power = std::log10(*first);  // of seconds since 1970: 8.5 to 10.5
  if (power > 11.5 && power < 13.5) return "ms";
  if (power > 14.5 && power < 16.5) return "us";
  if (power > 17.5 && power < 19.5) return "ns";
  return {};
}

bool counts_from_epoch(const std::vector<double>& times) {
  return !times.empty() && times.front() > earliest_epoch;
}

}  // namespace bbsim::file
