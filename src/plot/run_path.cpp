// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Draws the path in the plane: the ball, its reference and the plate's edge.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "plot/run_parts.hpp"
#include "plot/thin.hpp"

namespace bbsim::plot {
namespace {

struct Points {
  std::vector<double> x, y;
};

struct Extent {
  Range x, y;

  void include(const Points& points) {
    for (std::size_t i = 0; i < points.x.size(); ++i) {
      if (!std::isfinite(points.x[i]) || !std::isfinite(points.y[i])) continue;
      x.include(points.x[i]);
      y.include(points.y[i]);
    }
  }
  [[nodiscard]] double size() const { return std::max(x.width(), y.width()); }
};

// Empty if the run lacks a column.
Points points_of(const Result& run, const char* x, const char* y) {
  const Column* const of_x = run.find(x);
  const Column* const of_y = run.find(y);
  if (of_x == nullptr || of_y == nullptr) return {};
  return {of_x->numbers, of_y->numbers};
}

Points path_of(const Result& run) {
  return points_of(run, "x", "y");
}

Points reference_of(const Result& run) {
  return points_of(run, "x_reference", "y_reference");
}

bool stands_still(const Points& points) {
  Extent extent;
  extent.include(points);
  return !extent.x.wide() && !extent.y.wide();
}

// The edges of the known plates, m.
std::vector<Points> plates_of(const std::vector<Result>& runs) {
  std::vector<Points> plates;
  for (const Result& run : runs) {
    Points edge;
    if (!run.scenario) continue;
    if (const auto& diameter = run.scenario->plate.diameter) {
      constexpr int sides = 180;
      for (int i = 0; i <= sides; ++i) {
        const double angle = 2 * std::numbers::pi * i / sides;
        edge.x.push_back(*diameter / 2 * std::cos(angle));
        edge.y.push_back(*diameter / 2 * std::sin(angle));
      }
    } else if (const auto& size = run.scenario->plate.size) {
      const double x = (*size)[0] / 2, y = (*size)[1] / 2;
      edge = {{-x, x, x, -x, -x}, {-y, -y, y, y, -y}};
    }
    const bool known = std::ranges::any_of(
        plates, [&](const Points& other) { return other.x == edge.x && other.y == edge.y; });
    if (!edge.x.empty() && !known) plates.push_back(edge);
  }
  return plates;
}

// The first or the last finite point of a path.
Points end_of(const Points& points, bool first) {
  for (std::size_t n = 0; n < points.x.size(); ++n) {
    const std::size_t i = first ? n : points.x.size() - 1 - n;
    if (std::isfinite(points.x[i]) && std::isfinite(points.y[i]))
      return {{points.x[i]}, {points.y[i]}};
  }
  return {};
}

Stroke marker(const std::string& colour, Marker shape) {
  return {colour, 0, Dash::solid, shape, 1.5};
}

}  // namespace

bool has_path(const std::vector<Result>& runs) {
  Extent extent;
  for (const Result& run : runs) extent.include(path_of(run));
  return !extent.x.empty();
}

bool is_along_an_axis(const std::vector<Result>& runs) {
  Extent extent;
  for (const Result& run : runs) {
    extent.include(path_of(run));
    extent.include(reference_of(run));
  }
  if (extent.x.empty() || !plates_of(runs).empty()) return false;
  constexpr double unseen = 1e-6;  // part of the longer side
  return std::min(extent.x.width(), extent.y.width()) < unseen * extent.size();
}

void add_path(Picture& picture, const std::vector<Result>& runs, const EventMarks& marks,
              const Box& box) {
  const bool one = runs.size() == 1;
  Extent extent;
  for (const Result& run : runs) {
    extent.include(path_of(run));
    extent.include(reference_of(run));
    for (const Event& event : run.events) extent.include({{event.x}, {event.y}});
  }
  std::vector<Points> plates = plates_of(runs);
  // A plate ten times the path's size would make the path too small to see.
  const double most = 10 * extent.size();
  std::erase_if(plates, [most](const Points& edge) {
    Extent plate;
    plate.include(edge);
    return plate.size() > most;
  });
  for (const Points& plate : plates) extent.include(plate);

  // Widens the shorter range until both axes have the same scale.
  const PlaneScales scales = choose_scales(unit_of(runs, "x"), extent.x, extent.y);
  const Range x = scales.x(extent.x), y = scales.y(extent.y);
  const double aspect = box.width() / box.height();
  const double wide = std::max(x.width(), y.width() * aspect);
  const double largest = std::max(x.largest(), y.largest());
  const double half = 0.54 * (wide > 1e-9 * largest ? wide : largest > 0 ? largest : 1);
  const auto around = [](double middle, double by) { return Range{middle - by, middle + by}; };
  Panel panel{box, scales.y.heading("y")};
  panel.x = linear_axis(around(x.middle(), half), Along::x, box.width(), 0);
  panel.y = linear_axis(around(y.middle(), half / aspect), Along::y, box.height(), 0);
  panel.y.step = panel.x.step;
  panel.x.label = scales.x.heading("x");

  const auto name = [&](const char* words, const Stroke& stroke) {
    if (std::ranges::find(picture.legend, words, &LegendEntry::name) == picture.legend.end()) {
      picture.legend.push_back({words, stroke});
    }
  };
  const auto add = [&](const Points& points, const Stroke& stroke) {
    Curve line{Curve::Shape::line, stroke};
    for (std::size_t i = 0; i < points.x.size(); ++i) {
      line.add(scales.x(points.x[i]), scales.y(points.y[i]));
    }
    if (stroke.width > 0) panel.curves.push_back(lone_points(line));
    panel.curves.push_back(thin_path(std::move(line), panel));
  };
  if (one) name("path", stroke_of(0));
  for (const Result& run : runs) {
    const Points reference = reference_of(run);
    if (stands_still(reference)) continue;
    name("reference", band_of_reference);
    add(reference, band_of_reference);
  }
  for (const Points& plate : plates) {
    const Stroke edge{"#404040", 1.5};
    name("plate's edge", edge);
    add(plate, edge);
  }
  for (const Result& run : runs) add(path_of(run), stroke_of_run(runs, run));
  for (const Result& run : runs) {
    const Points reference = reference_of(run);
    if (reference.x.empty() || !stands_still(reference)) continue;
    name("reference", marker("#009e73", Marker::cross));
    add(end_of(reference, true), marker("#009e73", Marker::cross));
  }
  name("start", marker("#000000", Marker::ring));
  name("end", marker("#000000", Marker::dot));
  for (const Result& run : runs) {
    const std::string colour = one ? "#000000" : stroke_of_run(runs, run).colour;
    add(end_of(path_of(run), true), marker(colour, Marker::ring));
    add(end_of(path_of(run), false), marker(colour, Marker::dot));
    for (const Event& event : run.events)
      add({{event.x}, {event.y}}, marks.stroke_of(run, event.name));
  }
  picture.panels.push_back(std::move(panel));
}

}  // namespace bbsim::plot
