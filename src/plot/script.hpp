// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Picture -> a script for gnuplot, which writes the picture to its standard output.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "plot/picture.hpp"

namespace bbsim::plot {

enum class Format { svg, png, pdf };

// Whether a font of this machine has a letter for a character. It is asked for what DejaVu Sans,
// which comes with gnuplot, may not have.
using HasLetter = std::function<bool(std::uint32_t)>;

// gnuplot gets places in parts of the picture, colours and texts: it chooses nothing, and no text
// of the user's is anything but text to it. In PNG and PDF a character without a letter becomes
// U+FFFD: gnuplot's drawing library would write its number over all the picture.
[[nodiscard]] std::string gnuplot_script(const Picture& picture, Format format,
                                         const HasLetter& has_letter);

// What gnuplot made of it, mended: in texts of an SVG it leaves "]]>" as it is, which is no XML.
[[nodiscard]] std::string mended(std::string drawn, Format format);

// A picture with a mark, which is not to be seen, by which one of bbsim's is known.
[[nodiscard]] std::string marked(std::string drawn, Format format);
inline constexpr const char* picture_mark = "drawn by bbsim plot";

}  // namespace bbsim::plot
