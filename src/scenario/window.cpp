// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "scenario/window.hpp"

#include "base/number_text.hpp"
#include "base/text.hpp"
#include "yaml/quantity.hpp"

namespace bbsim::scenario {
namespace {

// Removes " WORD TIME" from the end of the text, if present.
std::optional<double> take_last(std::string_view& text, std::string_view word) {
  const std::size_t place = text.rfind(word);
  if (place == std::string_view::npos || place == 0) return {};
  const std::optional<double> time = yaml::value_in(text.substr(place + word.size()), "s");
  if (time) text = trimmed(text.substr(0, place));
  return time;
}

}  // namespace

WindowedName split_window(std::string_view name) {
  name = trimmed(name);
  WindowedName split{name};
  split.window.to = take_last(split.base, " to ");
  split.window.from = take_last(split.base, " from ");
  split.text = trimmed(name.substr(split.base.size()));
  return split;
}

std::string window_fault(const Window& window, double start, double end) {
  if (window.from && window.to && !(*window.from < *window.to)) {
    return "the window is empty; allowed: from a time to a later time";
  }
  const double rounding = rounding_of(end);
  const bool within = (!window.from || (*window.from >= start && *window.from < end)) &&
                      (!window.to || (*window.to > start && *window.to <= end + rounding));
  if (within) return "";
  return "the run is from " + number_text(start) + " to " + number_text(end) +
         " s; allowed: a window within it";
}

}  // namespace bbsim::scenario
