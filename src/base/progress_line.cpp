// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "base/progress_line.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "base/text.hpp"

namespace bbsim {
namespace {

constexpr std::size_t longest_bar = 30, shortest_bar = 8;

std::string time_text(double seconds) {
  const bool minutes = seconds > 120, hours = seconds > 7200;
  char text[40];
  std::snprintf(text, sizeof text, "%.*f %s", hours ? 1 : 0,
                seconds / (hours     ? 3600
                           : minutes ? 60
                                     : 1),
                hours     ? "h"
                : minutes ? "min"
                          : "s");
  return text;
}

std::string left_text(const ProgressState& state) {
  return state.seconds_left ? ", " + time_text(*state.seconds_left) + " left" : "";
}

std::string detail_text(const ProgressState& state) {
  return state.detail.empty() ? "" : ", " + state.detail;
}

std::string bar(double done, std::size_t length) {
  const auto filled = static_cast<std::size_t>(done * static_cast<double>(length));
  return '[' + std::string(filled, '#') + std::string(length - filled, '.') + ']';
}

bool is_ascii(char c) {
  return static_cast<unsigned char>(c) < 0x80;
}

// The text; if it does not fit, "..." and its end.
std::string end_of(const std::string& text, std::size_t columns) {
  if (widest(text) <= columns) return text;
  constexpr std::size_t dots = 3;
  if (columns <= dots) return "";
  std::size_t from = text.size(), room = columns - dots;
  while (from > 0) {
    std::size_t before = from - 1;  // start of the character before
    while (before > 0 && continues_character(text[before])) --before;
    const std::size_t width = is_ascii(text[before]) ? 1 : 2;
    if (width > room) break;
    room -= width;
    from = before;
  }
  return "..." + text.substr(from);
}

}  // namespace

std::size_t widest(const std::string& text) {
  std::size_t columns = 0;
  for (const char c : text) {
    columns += is_ascii(c) ? 1 : continues_character(c) ? 0 : 2;
  }
  return columns;
}

std::string log_line(const ProgressState& state) {
  char percent[16];
  std::snprintf(percent, sizeof percent, ": %.1f%%", 100 * state.done);
  return state.label + percent + detail_text(state) + left_text(state);
}

std::string progress_line(const ProgressState& state, std::size_t columns) {
  char percent[8];
  std::snprintf(percent, sizeof percent, "%3.0f%%", 100 * state.done);
  const std::string left = left_text(state), detail = detail_text(state);
  const std::string name = std::filesystem::path(state.label).filename().string();

  // Forms from long to short; the first with room for the shortest bar is used.
  struct Form {
    const std::string& label;
    const std::string after;
  };
  const Form forms[] = {{state.label, percent + detail + left},
                        {name, percent + detail + left},
                        {name, percent + left}};
  constexpr std::size_t around_bar = 4;  // brackets and spaces
  for (const Form& form : forms) {
    const std::size_t texts = widest(form.label) + widest(form.after) + around_bar;
    if (texts + shortest_bar > columns) continue;
    const std::size_t length = std::min(longest_bar, columns - texts);
    return form.label + ' ' + bar(state.done, length) + ' ' + form.after;
  }
  std::string line = percent + left;
  if (line.size() > columns) line = percent;
  constexpr std::size_t shortest_name = 8;
  if (line.size() + 1 + shortest_name <= columns) {
    line = end_of(name, columns - line.size() - 1) + ' ' + line;
  }
  return line;
}

}  // namespace bbsim
