// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Texts in a picture: permitted characters, widths, and cuts to fit.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace bbsim::plot {

// Returns `text` as one line of valid UTF-8 that every format can hold. Invalid characters and
// those that change the direction of text become U+FFFD; control characters become blanks.
[[nodiscard]] std::string clean(std::string_view text);

// Replaces characters of a clean text with U+FFFD if DejaVu Sans and `has_letter` lack them.
[[nodiscard]] std::string with_letters(std::string_view text,
                                       const std::function<bool(std::uint32_t)>& has_letter);

// An upper bound, except for rare letters, on the width of a clean text in a sans-serif font, in
// the unit of `size`. Each letter counts at least `narrowest` times the size.
[[nodiscard]] double width_of(std::string_view text, double size, double narrowest = 0);

// Shortens a text to `width`, if necessary, with "…" in the middle, because file names differ at
// either end.
[[nodiscard]] std::string cut(const std::string& text, double width, double size,
                              double narrowest = 0);

// A number for readers: at most `digits` digits, with a minus sign instead of a hyphen.
[[nodiscard]] std::string number(double value, int digits = 4);

// This power of 10, as text with superscripts.
[[nodiscard]] std::string power_of_ten(int exponent);

}  // namespace bbsim::plot
