// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The content of a picture, in the axes' own units. It depends neither on balls nor on the program
// that draws it (script.hpp).
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

// Colors that remain distinct with any color vision (Okabe and Ito's palette), in the order of
// lines, with dashes that distinguish lines without color.
[[nodiscard]] Stroke stroke_of(std::size_t line);

struct Tic {
  double at = 0;
  std::string label;
};

struct Axis {
  double low = 0, high = 1;  // low < high
  bool log = false;          // both above 0
  double step = 0;           // distance between tics; 0: the tics are in the list
  std::vector<Tic> tics{};
  std::string label{};
  bool numbered = true;  // whether the tics have labels

  // The position of a value: 0 at `low`, 1 at `high`.
  [[nodiscard]] double fraction(double value) const;
  // The value halfway between two values on the drawn axis.
  [[nodiscard]] double middle(double from, double to) const;
  // The number of decimals in the tics' labels.
  [[nodiscard]] int decimals() const;
};

// Pixels from the left edge and from the bottom of the picture's heading.
struct Box {
  double left = 0, top = 0, right = 0, bottom = 0;
  [[nodiscard]] double width() const { return right - left; }
  [[nodiscard]] double height() const { return bottom - top; }
};

// A line through points, with NaN for a gap; steps, which hold each value until the next; or the
// area between y and y_high.
struct Curve {
  enum class Shape { line, steps, band } shape = Shape::line;
  Stroke stroke;
  std::vector<double> x{}, y{};
  std::vector<double> y_high{};

  void add(double new_x, double new_y);
};

// The points of a line with a gap on either side, as dots: no line goes through them.
[[nodiscard]] Curve lone_points(const Curve& line);

// A filled rectangle. In a map, its color represents a value; NaN is gray.
struct Cell {
  double left = 0, right = 0, bottom = 0, top = 0;
  double value = std::numeric_limits<double>::quiet_NaN();
  std::string text{};  // centered in the cell
};

// A stroke and its name in a legend.
struct LegendEntry {
  std::string name;
  Stroke stroke;
};

struct Panel {
  Box box;
  std::string heading{};  // above its top left corner
  Axis x{}, y{};
  std::optional<Axis> colours{};      // in a map: its color scale, on the right
  std::vector<LegendEntry> legend{};  // in one row beside the heading
  std::vector<Cell> cells{};
  std::vector<Curve> curves{};  // from bottom to top
};

struct Picture {
  double width = 1200, height = 600;  // below the heading
  std::string title, subtitle;
  std::vector<LegendEntry> legend;
  std::vector<Panel> panels;
};

}  // namespace bbsim::plot
