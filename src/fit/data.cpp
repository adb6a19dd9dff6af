// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "fit/data.hpp"

#include <algorithm>
#include <cmath>

namespace bbsim::fit {
namespace {

std::size_t numbers_of(const Window& window) {
  std::size_t count = 0;
  for (const auto& column : window.values) {
    count += static_cast<std::size_t>(
        std::ranges::count_if(column, [](double value) { return std::isfinite(value); }));
  }
  return count;
}

Window rows_of(const Log& log, std::size_t number, std::size_t from, std::size_t to) {
  Window window;
  window.log = number;
  window.begin = log.times[from];
  for (std::size_t i = from; i < to; ++i) window.times.push_back(log.times[i] - window.begin);
  for (const std::vector<double>& column : log.values) {
    window.values.emplace_back(column.begin() + static_cast<std::ptrdiff_t>(from),
                               column.begin() + static_cast<std::ptrdiff_t>(to));
  }
  window.first = from == 0;
  return window;
}

}  // namespace

std::vector<Window> cut(const std::vector<Log>& logs, double length, double share,
                        std::size_t fewest) {
  std::vector<Window> windows;
  for (std::size_t k = 0; k < logs.size(); ++k) {
    const std::vector<double>& times = logs[k].times;
    if (times.empty()) continue;
    const double span = times.back() - times.front();
    // The last row of a log belongs to the last window.
    const double count = std::max(1.0, std::round(span / length));
    std::size_t from = 0;
    for (double w = 1; w <= count && from < times.size(); ++w) {
      const double end = times.front() + w * length * (1 - 1e-9);
      std::size_t to = times.size();
      if (w < count) {
        to = static_cast<std::size_t>(std::ranges::lower_bound(times, end) - times.begin());
      }
      if (to > from + 1) {
        Window window = rows_of(logs[k], k, from, to);
        if (numbers_of(window) > fewest) windows.push_back(std::move(window));
      }
      from = std::max(from, to);
    }
  }
  for (std::size_t i = 0; i < windows.size(); ++i) {
    const auto index = static_cast<double>(i);
    windows[i].held = std::floor((index + 1) * share) > std::floor(index * share);
  }
  return windows;
}

void find_joints(std::vector<Window>& windows) {
  const auto interval = [](const Window& window) {
    return (window.times.back() - window.times.front()) /
           static_cast<double>(window.times.size() - 1);
  };
  for (std::size_t w = 0; w + 1 < windows.size(); ++w) {
    Window& one = windows[w];
    const Window& next = windows[w + 1];
    const double pause = next.begin - (one.begin + one.times.back());
    one.goes_on = one.log == next.log && pause <= 5 * std::min(interval(one), interval(next));
  }
}

std::vector<std::size_t> start_coordinates(const std::vector<const scenario::Column*>& columns,
                                           bool with_gimbal) {
  bool along[2] = {false, false};
  for (const scenario::Column* const column : columns) {
    const std::string_view name = column->name;
    const bool x = name == "x" || name == "vx" || name == "x_measured";
    const bool y = name == "y" || name == "vy" || name == "y_measured";
    along[0] = along[0] || x || !y;  // any other column may depend on both
    along[1] = along[1] || y || !x;
  }
  std::vector<std::size_t> coordinates;
  for (const std::size_t i : {0U, 1U}) {
    if (along[i]) coordinates.push_back(i);
  }
  for (const std::size_t i : {0U, 1U}) {
    if (along[i]) coordinates.push_back(2 + i);
  }
  if (with_gimbal) {
    for (std::size_t i = 4; i < 8; ++i) coordinates.push_back(i);
  }
  return coordinates;
}

}  // namespace bbsim::fit
