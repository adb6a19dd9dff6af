// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Turns a picture into a script for gnuplot, which writes the picture to its standard output.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "plot/picture.hpp"

namespace bbsim::plot {

enum class Format { svg, png, pdf };

// Whether a font of this machine has a character. Called only for characters that DejaVu Sans,
// which comes with gnuplot, may lack.
using HasLetter = std::function<bool(std::uint32_t)>;

// The script fixes all positions, colors and texts: gnuplot chooses nothing and does not interpret
// the user's texts. PNG and PDF show U+FFFD for a missing character; gnuplot's drawing library
// would write its number across the picture.
[[nodiscard]] std::string gnuplot_script(const Picture& picture, Format format,
                                         const HasLetter& has_letter);

// Repairs gnuplot's output: its SVG texts contain "]]>" unescaped, which is not valid XML.
[[nodiscard]] std::string mended(std::string drawn, Format format);

// Adds an invisible mark that identifies pictures of bbsim.
[[nodiscard]] std::string marked(std::string drawn, Format format);
inline constexpr const char* picture_mark = "drawn by bbsim plot";

}  // namespace bbsim::plot
