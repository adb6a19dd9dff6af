// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Breaks text between words.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace bbsim::app {

// Wraps a text into lines of at most `width` columns that start at column `indent`; the first one
// is at `column` already. Longer words stay whole.
[[nodiscard]] std::string wrapped(std::string_view text, std::size_t indent, std::size_t column,
                                  std::size_t width);

}  // namespace bbsim::app
