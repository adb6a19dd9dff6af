// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Headings and legends, laid out by us, so that nothing in them collides whatever the names.
#pragma once

#include <string>
#include <vector>

#include "plot/picture.hpp"

namespace bbsim::plot {

struct Entry {
  std::string name;
  Stroke stroke;
};

inline constexpr double legend_size = 12;   // of the font
inline constexpr double legend_pitch = 19;  // from row to row

// Colours that are told apart with any colour vision (Okabe and Ito's palette), in the order in
// which lines take them, and the dashes that tell them apart without colour.
[[nodiscard]] Stroke stroke_of(std::size_t line);

// How many rows the entries need between two places.
[[nodiscard]] std::size_t legend_rows(const std::vector<Entry>& entries, double left, double right);

// Puts them there, aligned at the right or in the middle, the last row at `y`, the others above it.
// A name that is wider than a row is cut.
void place_legend(Picture& picture, const std::vector<Entry>& entries, double left, double right,
                  double y, Words::Align align = Words::Align::right);

// Puts the entries in one row: names are cut until all have room.
void place_in_a_row(Picture& picture, std::vector<Entry> entries, double left, double right,
                    double y);

// Title, subtitle and legend at a picture's top, where there are any; where the panels begin.
double add_heading(Picture& picture, const std::string& title, const std::string& subtitle,
                   const std::vector<Entry>& legend);

// A panel's heading, above its top left corner.
void add_heading(Picture& picture, const Box& box, const std::string& text);

// What an axis is of, below the middle of its panel.
void add_axis_label(Picture& picture, const Box& box, const std::string& text);

}  // namespace bbsim::plot
