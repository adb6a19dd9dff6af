// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Axes, units and marks of a sweep's picture (sweep_parts.hpp).
#include <algorithm>
#include <array>
#include <cmath>

#include "plot/columns.hpp"
#include "plot/sweep_parts.hpp"
#include "plot/text.hpp"
#include "scenario/measures.hpp"

namespace bbsim::plot {
namespace {

// Whether positive values grow by equal factors, over at least a factor of ten.
bool by_equal_factors(const std::vector<double>& values) {
  if (values.size() < 3 || values.front() <= 0 || values.back() / values.front() < 10) return false;
  const double factor = values[1] / values[0];
  for (std::size_t i = 2; i < values.size(); ++i) {
    if (std::abs(values[i] / values[i - 1] / factor - 1) > 1e-3) return false;
  }
  return true;
}

Unit unit_of_measure(const std::string& name) {
  if (name == "end_time") return {"s"};
  const std::optional<scenario::Measure> measure = scenario::find_measure(name);
  if (!measure) return {};
  const Unit unit{measure->unit() == "1" ? "" : measure->unit()};
  if (measure->kind == scenario::Measure::Kind::loop) {
    // Angles are shown in degrees; frequencies stay in rad/s.
    return measure->unit() == "rad" ? unit_of("phi") : unit;
  }
  // Measures in the column's own unit are shown like the column.
  if (measure->unit() == measure->column->unit) return unit_of(measure->column->name);
  return unit;
}

}  // namespace

Stroke stroke_of_status(const SweepTable& table, const std::string& status) {
  constexpr std::array shapes = {Marker::cross, Marker::plus, Marker::square, Marker::diamond,
                                 Marker::triangle};
  std::size_t index = 0;
  while (index < table.others.size() && table.others[index].first != status) ++index;
  return {"#d55e00", 0, Dash::solid, shapes[index % shapes.size()]};
}

MeasureAxis::MeasureAxis(const SweepTable& table, const Column& measure, double close) {
  Range whole;
  for (std::size_t i = 0; i < measure.numbers.size(); ++i) {
    if (table.done(i)) whole.include(measure.numbers[i]);
  }
  log = better_by_log(whole);
  scale = choose_scale(unit_of_measure(measure.name), whole, log ? 0 : close);
  range = scale(whole);
}

Axis MeasureAxis::axis(Along along, double pixels, double air) const {
  return log ? log_axis(range, along, pixels, air) : linear_axis(range, along, pixels, air);
}

KeyAxis::KeyAxis(const SweepTable& table, const Key& of) : key(of), label(of.name) {
  const std::vector<std::string> followers = table.followers(key);
  for (std::size_t i = 0; i < followers.size(); ++i) {
    label += (i == 0 ? ", with " : ", ") + followers[i];
  }
  if (key.is_text()) return;
  log = by_equal_factors(key.distinct);
  Range range;
  range.include(key.distinct);
  scale = choose_scale({key.unit}, range, log ? 0 : close_together);
  label = scale.heading(label);
}

std::vector<double> KeyAxis::edges() const {
  std::vector<double> at;
  for (const double value : key.distinct) at.push_back(log ? std::log(place(value)) : place(value));
  std::vector<double> edges(at.size() + 1);
  for (std::size_t i = 1; i < at.size(); ++i) edges[i] = (at[i - 1] + at[i]) / 2;
  edges.front() = at.front() - (edges[1] - at.front());
  edges.back() = at.back() + (at.back() - edges[at.size() - 1]);
  if (log) {
    for (double& edge : edges) edge = std::exp(edge);
  }
  return edges;
}

Axis KeyAxis::axis(Along along, double pixels, bool cells) const {
  const double air = cells ? 0 : 0.02;
  Range range{place(key.distinct.front()), place(key.distinct.back())};
  if (cells) range = {edges().front(), edges().back()};
  Axis axis;
  if (key.is_text()) {
    constexpr double font_size = 12;
    const auto count = static_cast<double>(key.labels.size());
    axis = {-0.5, count - 0.5};
    for (std::size_t i = 0; i < key.labels.size(); ++i) {
      const std::string word = cut(clean(key.labels[i]), 0.9 * pixels / count, font_size);
      axis.tics.push_back({static_cast<double>(i), word});
    }
  } else {
    axis = log ? log_axis(range, along, pixels, air) : linear_axis(range, along, pixels, air);
  }
  constexpr double label_size = 13;
  axis.label = cut(clean(label), pixels, label_size);
  return axis;
}

}  // namespace bbsim::plot
