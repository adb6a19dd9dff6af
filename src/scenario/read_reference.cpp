// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads `controller.reference`.
#include <utility>

#include "scenario/sections.hpp"
#include "scenario/table_rows.hpp"
#include "yaml/rules.hpp"

namespace bbsim::scenario {
namespace {

constexpr std::size_t fewest_waypoints = 2;  // a single point is a `point`
constexpr std::size_t most_waypoints = 10000;

void read_circle(yaml::Keys& keys, CircleReference& circle) {
  keys.required("radius", yaml::Number{yaml::Dimension::length, {.at_least = 0}}, circle.radius,
                {"R"});
  keys.required("rate", yaml::Number{yaml::Dimension::angular_rate}, circle.rate,
                {"ω; $x = c_x + R \\cos(\\omega t + p)$, $y = c_y + R \\sin(\\omega t + p)$"});
  keys.optional("phase", yaml::Number{yaml::Dimension::angle}, circle.phase, {"p"});
  keys.optional("center", yaml::PairOf{yaml::Dimension::length}, circle.centre, {"$(c_x, c_y)$"});
}

void read_lissajous(yaml::Keys& keys, LissajousReference& figure) {
  keys.required("amplitude", yaml::PairOf{yaml::Dimension::length}, figure.amplitude, {"[a, b]"});
  keys.required("rate", yaml::PairOf{yaml::Dimension::angular_rate}, figure.rate,
                {"$[\\omega_1, \\omega_2]$; $x = c_x + a \\cos(\\omega_1 t + p_1)$, $y = c_y + b "
                 "\\sin(\\omega_2 t + p_2)$"});
  keys.optional("phase", yaml::PairOf{yaml::Dimension::angle}, figure.phase, {"$[p_1, p_2]$"});
  keys.optional("center", yaml::PairOf{yaml::Dimension::length}, figure.centre, {"$(c_x, c_y)$"});
}

void check_times(const yaml::Value& value, const std::vector<double>& times, std::size_t points) {
  if (times.size() != points) {
    value.report("found " + std::to_string(times.size()) + " times for " + std::to_string(points) +
                 " points; allowed: one time for each point");
    return;
  }
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (times[i] > times[i - 1]) continue;
    value.item(i).refuse(", after " + yaml::shown(*value.item(i - 1).node),
                         "strictly increasing times");
  }
}

void read_timed_points(yaml::Keys& keys, std::vector<Pair>& points, std::vector<double>& times,
                       std::string_view about_times) {
  const yaml::ListOf<yaml::PairOf, Pair> some_points{
      {yaml::Dimension::length}, fewest_waypoints, most_waypoints, "points [x, y]"};
  const yaml::ListOf<yaml::Number, double> some_times{
      {yaml::Dimension::time}, fewest_waypoints, most_waypoints, "times, one for each point"};
  bool fine = keys.required("points", some_points, points,
                            {.meaning = "points (x, y)", .range = "2 to 10,000"});
  fine =
      keys.required("times", some_times, times, {.meaning = about_times, .range = "increasing"}) &&
      fine;
  if (fine) check_times(*keys.find("times"), times, points.size());
}

void read_waypoints(yaml::Keys& keys, WaypointReference& way) {
  read_timed_points(keys, way.points, way.times, "the time at each point, one for each");
  keys.optional("rest", yaml::NameOf<bool>{{{true, "true"}, {false, "false"}}}, way.rest,
                {"true: at rest at each point, with least jerk between; false: a C2 spline through "
                 "the points",
                 "-"});
}

void read_staircase(yaml::Keys& keys, StaircaseReference& stairs) {
  read_timed_points(keys, stairs.points, stairs.jumps,
                    "the time from which each point holds, one for each");
  // The first point also holds before its time.
  if (!stairs.jumps.empty()) stairs.jumps.erase(stairs.jumps.begin());
}

void read_step(yaml::Keys& keys, StaircaseReference& step) {
  step.points.resize(2);
  step.jumps.resize(1);
  keys.optional("from", yaml::PairOf{yaml::Dimension::length}, step.points[0],
                {"the point before the step"});
  keys.required("to", yaml::PairOf{yaml::Dimension::length}, step.points[1],
                {"the point from the step on"});
  keys.optional("at", yaml::Number{yaml::Dimension::time, {.at_least = 0}}, step.jumps[0],
                {"the time of the step"});
}

void read_square(yaml::Keys& keys, SquareReference& square) {
  keys.required("amplitude", yaml::PairOf{yaml::Dimension::length}, square.amplitude,
                {"[a, b]: from the center to either side"});
  keys.required("period", yaml::Number{yaml::Dimension::time, {.above = 0}}, square.period, {"T"});
  keys.optional("phase", yaml::PairOf{yaml::Dimension::angle}, square.phase,
                {"$[p_1, p_2]$; $x = c_x + a$ where $2\\pi t/T + p_1$ is in the first `duty` of a "
                 "turn, and $c_x - a$ in the rest; y likewise"});
  keys.optional("center", yaml::PairOf{yaml::Dimension::length}, square.centre, {"$(c_x, c_y)$"});
  keys.optional("duty", yaml::Number{yaml::Dimension::number, {.at_least = 0.01, .at_most = 0.99}},
                square.duty, {"the part of a period at + a"});
}

void read_table_reference(yaml::Keys& keys, TableReference& table) {
  TableRows rows;
  keys.about({"unit", "time_unit"},
             {.meaning = "units of x and y, and of the times", .standard = "m, s"});
  keys.about({"scale"}, {"value = offset + scale × table; the offset in the table's own unit; a "
                         "list of two gives x and y their own",
                         "-", "1, 0"});
  read_table_rows(keys, {"x", "y"}, yaml::Dimension::length, rows);
  if (rows.values.empty()) return;
  table.file = std::move(rows.file);
  table.times = std::move(rows.times);
  table.x = std::move(rows.values[0]);
  table.y = std::move(rows.values[1]);
}

// Reads the reference at the key, if present.
template <class Rule, class Kind>
void read_kind(yaml::Keys& keys, std::string_view key, const Rule& rule, Kind kind,
               Reference& reference, const yaml::About& about = {}) {
  if (const std::optional<yaml::Value> value = keys.find(key, rule, about)) {
    rule.read(*value, kind);
    reference = std::move(kind);
  }
}

struct PointRule : yaml::PairOf {
  PointRule() : yaml::PairOf{yaml::Dimension::length} {}
  bool read(const yaml::Value& value, PointReference& into) const {
    return yaml::PairOf::read(value, into.position);
  }
};

}  // namespace

void read_reference(yaml::Keys& keys, Reference& reference) {
  keys.exactly_one(
      {"circle", "point", "lissajous", "waypoints", "table", "step", "square", "staircase"});
  read_kind(keys, "circle", yaml::MappingOf(read_circle), CircleReference{}, reference);
  read_kind(keys, "point", PointRule{}, PointReference{}, reference,
            {.meaning = "[x, y], a point at rest", .standard = "-"});
  read_kind(keys, "lissajous", yaml::MappingOf(read_lissajous), LissajousReference{}, reference);
  read_kind(keys, "waypoints", yaml::MappingOf(read_waypoints), WaypointReference{}, reference);
  read_kind(keys, "table", yaml::MappingOf(read_table_reference), TableReference{}, reference);
  read_kind(keys, "step", yaml::MappingOf(read_step), StaircaseReference{}, reference);
  read_kind(keys, "square", yaml::MappingOf(read_square), SquareReference{}, reference);
  read_kind(keys, "staircase", yaml::MappingOf(read_staircase), StaircaseReference{}, reference);
}

}  // namespace bbsim::scenario
