// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What is in a picture, in the axes' own units. Nothing here knows of balls, and nothing of the
// program that draws it (script.hpp).
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
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

// Colours that are told apart with any colour vision (Okabe and Ito's palette), in the order in
// which lines take them, and the dashes that tell them apart without colour.
[[nodiscard]] Stroke stroke_of(std::size_t line);

struct Tic {
  double at = 0;
  std::string label;
};

struct Axis {
  double low = 0, high = 1;  // low < high
  bool log = false;          // both above 0
  double step = 0;           // from tic to tic; 0: the tics are in the list
  std::vector<Tic> tics{};
  std::string label{};
  bool numbered = true;  // whether the tics have labels

  // Where a value is: 0 at `low`, 1 at `high`.
  [[nodiscard]] double fraction(double value) const;
  // The middle of a stretch as the eye sees it.
  [[nodiscard]] double middle(double from, double to) const;
  // Of the tics' labels, after the point.
  [[nodiscard]] int decimals() const;
};

// Pixels from the left, and from below the picture's heading.
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
  std::vector<double> x{}, y{};
  std::vector<double> y_high{};

  void add(double new_x, double new_y);
};

// Of a line those points that have a gap on either side, as dots: no line goes through them.
[[nodiscard]] Curve lone_points(const Curve& line);

// A filled rectangle. Of a map, its colour stands for a value, and NaN is gray.
struct Cell {
  double left = 0, right = 0, bottom = 0, top = 0;
  double value = std::numeric_limits<double>::quiet_NaN();
  std::string text{};  // in its middle
};

// What a legend says of a stroke.
struct Entry {
  std::string name;
  Stroke stroke;
};

struct Panel {
  Box box;
  std::string heading{};  // above its top left corner
  Axis x{}, y{};
  std::optional<Axis> colours{};  // of a map: its scale of colours is at its right
  std::vector<Entry> legend{};    // in one row beside the heading
  std::vector<Cell> cells{};
  std::vector<Curve> curves{};  // from the lowest to the uppermost
};

struct Picture {
  double width = 1200, height = 600;  // below the heading
  std::string title, subtitle;
  std::vector<Entry> legend;
  std::vector<Panel> panels;
};

}  // namespace bbsim::plot
