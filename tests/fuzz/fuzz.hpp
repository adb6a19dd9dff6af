// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Shared by the fuzz targets. libFuzzer calls each with one input after another; an uncaught
// exception, a sanitizer report or a broken promise is a finding.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"

namespace bbsim_fuzz {

// Ends the process, so that libFuzzer keeps the input.
inline void must(bool holds) {
  if (!holds) std::abort();
}

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

// Removes a line with its line break from the front of `text`; returns it without the break.
inline std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return line;
}

// Runs `action`, which may refuse its input if every problem has a text.
template <class Action>
void may_refuse(Action action) {
  try {
    action();
  } catch (const bbsim::InputError& error) {
    must(!error.problems().empty());
    for (const bbsim::Problem& problem : error.problems()) must(!problem.message.empty());
  }
}

}  // namespace bbsim_fuzz
