// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Words in a picture: what may stand there, how wide it is, how it is cut to fit.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace bbsim::plot {

// `text` as one line of valid UTF-8 that every format can hold: what is no character, or turns the
// direction of writing, becomes U+FFFD; line breaks and other control characters become blanks.
[[nodiscard]] std::string clean(std::string_view text);

// A clean text with U+FFFD for each character that neither DejaVu Sans nor `has_letter` has.
[[nodiscard]] std::string with_letters(std::string_view text,
                                       const std::function<bool(std::uint32_t)>& has_letter);

// An upper bound, but for rare letters, on the width of a clean text in a sans-serif font, in
// pixels as `size` is. No letter counts for less than the part `narrowest` of the size.
[[nodiscard]] double width_of(std::string_view text, double size, double narrowest = 0);

// The text, or as much of it as fits into `width` with "…" for the rest: in its middle, since names
// of files differ at either end.
[[nodiscard]] std::string cut(const std::string& text, double width, double size,
                              double narrowest = 0);

// A number as a person reads it: up to `digits` of them, with a minus sign rather than a hyphen.
[[nodiscard]] std::string number(double value, int digits = 4);

// 10 to that power, as text with superscripts.
[[nodiscard]] std::string power_of_ten(int exponent);

}  // namespace bbsim::plot
