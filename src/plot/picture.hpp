// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What is in a picture, in pixels from the top left and in the axes' own units. Nothing here knows
// of balls, and nothing of the program that draws it (script.hpp).
#pragma once

#include <string>
#include <vector>

namespace bbsim::plot {

enum class Dash { solid, dashed, dotted, dash_dotted };
enum class Marker { none, plus, cross, square, filled_square, ring, dot, triangle, diamond };

struct Stroke {
  std::string colour = "#000000";
  double width = 2;  // of a line; 0 draws none
  Dash dash = Dash::solid;
  Marker marker = Marker::none;
  double marker_size = 1;
};

struct Tic {
  double at = 0;
  std::string label;  // may be empty
};

struct Axis {
  double low = 0, high = 1;  // low < high
  bool log = false;          // both above 0
  std::vector<Tic> tics{};
  bool at_right = false;  // the labels of a vertical axis

  // Where a value is: 0 at `low`, 1 at `high`; NaN where the axis has no place for it.
  [[nodiscard]] double fraction(double value) const;
};

struct Box {
  double left = 0, top = 0, right = 0, bottom = 0;
  [[nodiscard]] double width() const { return right - left; }
  [[nodiscard]] double height() const { return bottom - top; }
};

// A line through points, with NaN for a gap; or steps, each value held until the next; or the
// area between y and y_high.
struct Curve {
  enum class Shape { line, steps, band } shape = Shape::line;
  Stroke stroke;
  std::vector<double> x, y;
  std::vector<double> y_high{};
};

// Of a line those points that have a gap on either side, as dots: no line goes through them.
[[nodiscard]] Curve lone_points(const Curve& line);

// A filled rectangle. Neighbours come in the order of their columns, each from below.
struct Cell {
  double left = 0, right = 0, bottom = 0, top = 0;
  unsigned rgb = 0;
};

// A line across the panel at one x, with a marker at its top.
struct Upright {
  double x = 0;
  Stroke stroke;
};

struct Panel {
  Box box;
  Axis x, y;
  bool grid = true;
  bool framed = false;    // on all sides, not only where the axes are
  bool is_scale = false;  // the colours of the one before, not to be counted
  std::vector<Cell> cells{};
  std::vector<Curve> curves{};  // from the lowest to the uppermost
  std::vector<Upright> uprights{};
};

struct Words {
  enum class Align { left, centre, right } align = Align::left;
  double x = 0, y = 0;  // of the middle of the line's height
  std::string text;
  double size = 13;
  std::string colour = "#202020";
  bool upwards = false;  // turned by 90 degrees, to be read from below
};

// A piece of a line, with its marker in the middle: what a legend shows.
struct Sample {
  double x = 0, y = 0, length = 0;
  Stroke stroke;
};

struct Picture {
  double width = 1200, height = 600;
  std::vector<Panel> panels;
  std::vector<Words> words;
  std::vector<Sample> samples;
};

}  // namespace bbsim::plot
