// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The path in the plane: where the ball was, where it was to be, and where the plate ends.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "plot/run_parts.hpp"
#include "plot/text.hpp"
#include "plot/thin.hpp"

namespace bbsim::plot {
namespace {

const Stroke edge_of_plate{"#404040", 1.5};

struct Plate {
  double half_x = 0, half_y = 0;  // m
  bool round = false;
  friend bool operator==(const Plate&, const Plate&) = default;
};

std::vector<Plate> plates_of(const std::vector<Result>& runs) {
  std::vector<Plate> plates;
  for (const Result& run : runs) {
    if (!run.scenario) continue;
    const auto& known = run.scenario->plate;
    Plate plate;
    if (known.diameter) {
      plate = {*known.diameter / 2, *known.diameter / 2, true};
    } else if (known.size) {
      plate = {(*known.size)[0] / 2, (*known.size)[1] / 2, false};
    } else {
      continue;
    }
    if (std::ranges::find(plates, plate) == plates.end()) plates.push_back(plate);
  }
  return plates;
}

Curve edge_of(const Plate& plate) {
  Curve curve{Curve::Shape::line, edge_of_plate, {}, {}};
  const auto add = [&](double x, double y) {
    curve.x.push_back(x);
    curve.y.push_back(y);
  };
  if (plate.round) {
    constexpr int sides = 180;
    for (int i = 0; i <= sides; ++i) {
      const double angle = 2 * std::numbers::pi * i / sides;
      add(plate.half_x * std::cos(angle), plate.half_y * std::sin(angle));
    }
    return curve;
  }
  for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}}) {
    add(x * plate.half_x, y * plate.half_y);
  }
  return curve;
}

struct Extent {
  Range x, y;
  [[nodiscard]] double size() const {
    return std::max(x.empty() ? 0 : x.high - x.low, y.empty() ? 0 : y.high - y.low);
  }
};

// Whether both coordinates are numbers.
struct Points {
  std::vector<double> x, y;
};

Points points_of(const Result& run, const char* x, const char* y) {
  const Column* const of_x = run.find(x);
  const Column* const of_y = run.find(y);
  if (of_x == nullptr || of_y == nullptr) return {};
  return {of_x->numbers, of_y->numbers};
}

void include(Extent& extent, const Points& points) {
  for (std::size_t i = 0; i < points.x.size(); ++i) {
    if (!std::isfinite(points.x[i]) || !std::isfinite(points.y[i])) continue;
    extent.x.include(points.x[i]);
    extent.y.include(points.y[i]);
  }
}

// Whether all points of a path are one.
bool stands_still(const Points& points) {
  Extent extent;
  include(extent, points);
  return !extent.x.wide() && !extent.y.wide();
}

// The first or the last point of a path.
void add_end(Panel& panel, const Points& points, bool first, const Stroke& stroke) {
  Curve curve{Curve::Shape::line, stroke, {}, {}};
  for (std::size_t n = 0; n < points.x.size() && curve.x.empty(); ++n) {
    const std::size_t i = first ? n : points.x.size() - 1 - n;
    if (!std::isfinite(points.x[i]) || !std::isfinite(points.y[i])) continue;
    curve.x.push_back(points.x[i]);
    curve.y.push_back(points.y[i]);
  }
  panel.curves.push_back(curve);
}

Stroke marker(const std::string& colour, Marker shape, double size = 1) {
  return {colour, 0, Dash::solid, shape, size};
}

}  // namespace

bool has_path(const std::vector<Result>& runs) {
  Extent extent;
  for (const Result& run : runs) include(extent, points_of(run, "x", "y"));
  return !extent.x.empty();
}

bool is_along_an_axis(const std::vector<Result>& runs) {
  Extent extent;
  for (const Result& run : runs) {
    include(extent, points_of(run, "x", "y"));
    include(extent, points_of(run, "x_reference", "y_reference"));
  }
  if (extent.x.empty() || !plates_of(runs).empty()) return false;
  constexpr double unseen = 1e-6;  // part of the longer side
  const double along_x = extent.x.high - extent.x.low, along_y = extent.y.high - extent.y.low;
  return std::min(along_x, along_y) < unseen * std::max(along_x, along_y);
}

void add_path(Picture& picture, const std::vector<Result>& runs, const EventMarks& marks, Box box) {
  const bool one = runs.size() == 1;
  Extent extent;
  std::vector<Points> paths, references;
  bool moving_reference = false, fixed_reference = false;
  for (const Result& run : runs) {
    paths.push_back(points_of(run, "x", "y"));
    references.push_back(points_of(run, "x_reference", "y_reference"));
    include(extent, paths.back());
    include(extent, references.back());
    if (!references.back().x.empty()) {
      (stands_still(references.back()) ? fixed_reference : moving_reference) = true;
    }
    for (const Event& event : run.events) include(extent, {{event.x}, {event.y}});
  }
  // A plate of ten times the path's size would leave nothing of the path to be seen.
  std::vector<Plate> plates = plates_of(runs);
  const double path_size = extent.size();
  std::erase_if(plates, [&](const Plate& plate) {
    return 2 * std::max(plate.half_x, plate.half_y) > 10 * path_size;
  });
  for (const Plate& plate : plates) {
    include(extent, {{-plate.half_x, plate.half_x}, {-plate.half_y, plate.half_y}});
  }

  std::vector<Entry> legend;
  if (one) legend.push_back({"path", stroke_of(0)});
  if (moving_reference) legend.push_back({"reference", band_of_reference});
  if (fixed_reference) legend.push_back({"reference", marker("#009e73", Marker::cross, 1.3)});
  if (!plates.empty()) legend.push_back({"plate's edge", edge_of_plate});
  legend.push_back({"start", marker("#000000", Marker::ring, 1.3)});
  legend.push_back({"end", marker("#000000", Marker::dot, 1.3)});
  for (const Entry& entry : marks.legend()) legend.push_back(entry);

  const auto [x_scale, y_scale] = choose_scales(unit_of(runs, "x"), extent.x, extent.y);
  const double legend_left = box.left + 70;  // beside the heading
  box.top += 8 + legend_pitch * static_cast<double>(legend_rows(legend, legend_left, box.right));
  place_legend(picture, legend, legend_left, box.right, box.top - 14);
  add_heading(picture, box, y_scale.heading("y"));
  add_axis_label(picture, box, x_scale.heading("x"));

  // Drawn to scale: the shorter range is widened until both axes have one.
  Panel panel;
  panel.box = box;
  const double aspect = box.width() / box.height();
  const double wide = std::max(x_scale(extent.x.high) - x_scale(extent.x.low),
                               (y_scale(extent.y.high) - y_scale(extent.y.low)) * aspect);
  const double largest =
      std::max({std::abs(x_scale(extent.x.low)), std::abs(x_scale(extent.x.high)),
                std::abs(y_scale(extent.y.low)), std::abs(y_scale(extent.y.high))});
  const double half = 0.54 * (wide > 1e-9 * largest ? wide : largest > 0 ? largest : 1);
  const double x = x_scale(extent.x.low / 2 + extent.x.high / 2);
  const double y = y_scale(extent.y.low / 2 + extent.y.high / 2);
  panel.x = across(tight_axis({x - half, x + half}, box.width(), 75), box.width());
  panel.y = tight_axis({y - half / aspect, y + half / aspect}, box.height(), 75);

  const auto scaled = [x_scale = x_scale, y_scale = y_scale](Points points) {
    for (double& value : points.x) value = x_scale(value);
    for (double& value : points.y) value = y_scale(value);
    return points;
  };
  const auto add = [&](const Points& points, const Stroke& stroke) {
    Points drawn = scaled(points);
    const Curve line{Curve::Shape::line, stroke, std::move(drawn.x), std::move(drawn.y)};
    if (const Curve lone = lone_points(line); !lone.x.empty()) panel.curves.push_back(lone);
    panel.curves.push_back(thin_path(line, panel));
  };
  for (const Points& reference : references) {
    if (!stands_still(reference)) add(reference, band_of_reference);
  }
  for (const Plate& plate : plates) {
    const Curve edge = edge_of(plate);
    add({edge.x, edge.y}, edge.stroke);
  }
  for (std::size_t r = 0; r < runs.size(); ++r) add(paths[r], stroke_of_run(runs, runs[r]));
  for (const Points& reference : references) {
    if (reference.x.empty() || !stands_still(reference)) continue;
    add_end(panel, scaled(reference), true, marker("#009e73", Marker::cross, 1.5));
  }
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const std::string colour = one ? "#000000" : stroke_of_run(runs, runs[r]).colour;
    const Points points = scaled(paths[r]);
    add_end(panel, points, true, marker(colour, Marker::ring, 1.5));
    add_end(panel, points, false, marker(colour, Marker::dot, 1.5));
    for (const Event& event : runs[r].events) {
      Stroke stroke = marks.stroke_of(runs[r], event);
      stroke.width = 0;
      panel.curves.push_back({Curve::Shape::line, stroke, {x_scale(event.x)}, {y_scale(event.y)}});
    }
  }
  picture.panels.push_back(std::move(panel));
}

}  // namespace bbsim::plot
