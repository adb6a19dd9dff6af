// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "plot/legend.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "plot/text.hpp"

namespace bbsim::plot {
namespace {

constexpr double gap_to_name = 6, gap_to_next = 16;
constexpr double line_length = 26, marker_length = 10;

double sample_length(const Stroke& stroke) {
  return stroke.width > 0 ? line_length : marker_length;
}

struct Placed {
  std::string name;  // as it fits
  Stroke stroke;
  double width = 0;
};

std::vector<std::vector<Placed>> rows_of(const std::vector<Entry>& entries, double room) {
  std::vector<std::vector<Placed>> rows;
  double used = 0;
  for (const Entry& entry : entries) {
    const double sample = sample_length(entry.stroke) + gap_to_name;
    Placed placed{cut_middle(clean(entry.name), room - sample, legend_size), entry.stroke};
    placed.width = sample + width_of(placed.name, legend_size);
    if (rows.empty() || used + gap_to_next + placed.width > room) {
      rows.emplace_back();
      used = placed.width;
    } else {
      used += gap_to_next + placed.width;
    }
    rows.back().push_back(std::move(placed));
  }
  return rows;
}

}  // namespace

Stroke stroke_of(std::size_t line) {
  constexpr std::array colours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                  "#e69f00", "#56b4e9", "#000000"};
  constexpr std::array dashes = {Dash::solid, Dash::dashed, Dash::dotted, Dash::dash_dotted};
  Stroke stroke;
  stroke.colour = colours[line % colours.size()];
  stroke.dash = dashes[line % dashes.size()];
  return stroke;
}

std::size_t legend_rows(const std::vector<Entry>& entries, double left, double right) {
  return rows_of(entries, right - left).size();
}

void place_legend(Picture& picture, const std::vector<Entry>& entries, double left, double right,
                  double y, Words::Align align) {
  const auto rows = rows_of(entries, right - left);
  y -= legend_pitch * static_cast<double>(std::max<std::size_t>(rows.size(), 1) - 1);
  for (const auto& row : rows) {
    double width = -gap_to_next;
    for (const Placed& placed : row) width += placed.width + gap_to_next;
    double x = align == Words::Align::right ? right - width : (left + right - width) / 2;
    for (const Placed& placed : row) {
      const double length = sample_length(placed.stroke);
      picture.samples.push_back({x, y, length, placed.stroke});
      picture.words.push_back(
          {Words::Align::left, x + length + gap_to_name, y, placed.name, legend_size});
      x += placed.width + gap_to_next;
    }
    y += legend_pitch;
  }
}

void place_in_a_row(Picture& picture, std::vector<Entry> entries, double left, double right,
                    double y) {
  if (legend_rows(entries, left, right) > 1) {
    const double each = (right - left) / static_cast<double>(entries.size()) - gap_to_next - 1;
    for (Entry& entry : entries) {
      const double room = each - sample_length(entry.stroke) - gap_to_name;
      entry.name = cut_middle(clean(entry.name), room, legend_size);
    }
  }
  place_legend(picture, entries, left, right, y);
}

double add_heading(Picture& picture, const std::string& title, const std::string& subtitle,
                   const std::vector<Entry>& legend) {
  constexpr double title_size = 17, subtitle_size = 12;
  const double room = picture.width - 60, middle = picture.width / 2;
  double y = 26;
  if (!title.empty()) {
    picture.words.push_back(
        {Words::Align::centre, middle, y, cut(title, room, title_size), title_size});
    y += 23;
  }
  if (!subtitle.empty()) {
    picture.words.push_back({Words::Align::centre, middle, y,
                             cut_middle(subtitle, room, subtitle_size), subtitle_size, "#505050"});
    y += 20;
  }
  if (legend.empty()) return y - 8;
  const double left = 30, right = picture.width - 30;
  y += 5 + legend_pitch * static_cast<double>(legend_rows(legend, left, right) - 1);
  place_legend(picture, legend, left, right, y, Words::Align::centre);
  return y + 12;
}

void add_heading(Picture& picture, const Box& box, const std::string& text) {
  constexpr double size = 13;
  const double room = std::max(box.width() * 0.7, 100.0);
  picture.words.push_back(
      {Words::Align::left, box.left - 4, box.top - 12, cut(clean(text), room, size), size});
}

void add_axis_label(Picture& picture, const Box& box, const std::string& text) {
  constexpr double size = 13, below = 39;
  picture.words.push_back({Words::Align::centre, (box.left + box.right) / 2, box.bottom + below,
                           cut_middle(clean(text), box.width(), size), size});
}

}  // namespace bbsim::plot
