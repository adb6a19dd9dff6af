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
  keys.required("radius", yaml::Number{yaml::Dimension::length, {.at_least = 0}}, circle.radius);
  keys.required("rate", yaml::Number{yaml::Dimension::angular_rate}, circle.rate);
  keys.optional("phase", yaml::Number{yaml::Dimension::angle}, circle.phase);
  keys.optional("center", yaml::PairOf{yaml::Dimension::length}, circle.centre);
}

void read_lissajous(yaml::Keys& keys, LissajousReference& figure) {
  keys.required("amplitude", yaml::PairOf{yaml::Dimension::length}, figure.amplitude);
  keys.required("rate", yaml::PairOf{yaml::Dimension::angular_rate}, figure.rate);
  keys.optional("phase", yaml::PairOf{yaml::Dimension::angle}, figure.phase);
  keys.optional("center", yaml::PairOf{yaml::Dimension::length}, figure.centre);
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

void read_timed_points(yaml::Keys& keys, std::vector<Pair>& points, std::vector<double>& times) {
  const yaml::ListOf<yaml::PairOf, Pair> some_points{
      {yaml::Dimension::length}, fewest_waypoints, most_waypoints, "points [x, y]"};
  const yaml::ListOf<yaml::Number, double> some_times{
      {yaml::Dimension::time}, fewest_waypoints, most_waypoints, "times, one for each point"};
  bool fine = keys.required("points", some_points, points);
  fine = keys.required("times", some_times, times) && fine;
  if (fine) check_times(*keys.find("times"), times, points.size());
}

void read_waypoints(yaml::Keys& keys, WaypointReference& way) {
  read_timed_points(keys, way.points, way.times);
  keys.optional("rest", yaml::NameOf<bool>{{{true, "true"}, {false, "false"}}}, way.rest);
}

void read_staircase(yaml::Keys& keys, StaircaseReference& stairs) {
  read_timed_points(keys, stairs.points, stairs.jumps);
  // The first point also holds before its time.
  if (!stairs.jumps.empty()) stairs.jumps.erase(stairs.jumps.begin());
}

void read_step(yaml::Keys& keys, StaircaseReference& step) {
  step.points.resize(2);
  step.jumps.resize(1);
  keys.optional("from", yaml::PairOf{yaml::Dimension::length}, step.points[0]);
  keys.required("to", yaml::PairOf{yaml::Dimension::length}, step.points[1]);
  keys.optional("at", yaml::Number{yaml::Dimension::time, {.at_least = 0}}, step.jumps[0]);
}

void read_square(yaml::Keys& keys, SquareReference& square) {
  keys.required("amplitude", yaml::PairOf{yaml::Dimension::length}, square.amplitude);
  keys.required("period", yaml::Number{yaml::Dimension::time, {.above = 0}}, square.period);
  keys.optional("phase", yaml::PairOf{yaml::Dimension::angle}, square.phase);
  keys.optional("center", yaml::PairOf{yaml::Dimension::length}, square.centre);
  keys.optional("duty", yaml::Number{yaml::Dimension::number, {.at_least = 0.01, .at_most = 0.99}},
                square.duty);
}

void read_table_reference(yaml::Keys& keys, TableReference& table) {
  TableRows rows;
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
               Reference& reference) {
  if (const std::optional<yaml::Value> value = keys.find(key, rule)) {
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
  read_kind(keys, "point", PointRule{}, PointReference{}, reference);
  read_kind(keys, "lissajous", yaml::MappingOf(read_lissajous), LissajousReference{}, reference);
  read_kind(keys, "waypoints", yaml::MappingOf(read_waypoints), WaypointReference{}, reference);
  read_kind(keys, "table", yaml::MappingOf(read_table_reference), TableReference{}, reference);
  read_kind(keys, "step", yaml::MappingOf(read_step), StaircaseReference{}, reference);
  read_kind(keys, "square", yaml::MappingOf(read_square), SquareReference{}, reference);
  read_kind(keys, "staircase", yaml::MappingOf(read_staircase), StaircaseReference{}, reference);
}

}  // namespace bbsim::scenario
