#include <utility>

#include "scenario/rules.hpp"
#include "scenario/sections.hpp"
#include "scenario/table_rows.hpp"

namespace bbsim::input {
namespace {

constexpr std::size_t fewest_waypoints = 2;  // a single one is a `point`
constexpr std::size_t most_waypoints = 10000;

void read_circle(Keys& keys, CircleReference& circle) {
  keys.required("radius", Number{Dimension::length, {.at_least = 0}}, circle.radius);
  keys.required("rate", Number{Dimension::angular_rate}, circle.rate);
  keys.optional("phase", Number{Dimension::angle}, circle.phase);
  keys.optional("centre", PairOf{Dimension::length}, circle.centre);
}

void read_lissajous(Keys& keys, LissajousReference& figure) {
  keys.required("amplitude", PairOf{Dimension::length}, figure.amplitude);
  keys.required("rate", PairOf{Dimension::angular_rate}, figure.rate);
  keys.optional("phase", PairOf{Dimension::angle}, figure.phase);
  keys.optional("centre", PairOf{Dimension::length}, figure.centre);
}

void check_times(const Value& times, const WaypointReference& way) {
  if (way.times.size() != way.points.size()) {
    times.report("found " + std::to_string(way.times.size()) + " times for " +
                 std::to_string(way.points.size()) + " points; allowed: one time for each point");
    return;
  }
  for (std::size_t i = 1; i < way.times.size(); ++i) {
    if (way.times[i] > way.times[i - 1]) continue;
    times.item(i).refuse(", after " + shown(*times.item(i - 1).node), "strictly increasing times");
  }
}

void read_waypoints(Keys& keys, WaypointReference& way) {
  const ListOf<PairOf, Pair> points{
      {Dimension::length}, fewest_waypoints, most_waypoints, "points [x, y]"};
  const ListOf<Number, double> times{
      {Dimension::time}, fewest_waypoints, most_waypoints, "times, one for each point"};
  bool fine = keys.required("points", points, way.points);
  fine = keys.required("times", times, way.times) && fine;
  keys.optional("rest", NameOf<bool>{{{true, "true"}, {false, "false"}}}, way.rest);
  if (fine) check_times(*keys.find("times"), way);
}

void read_table(Keys& keys, TableReference& table) {
  TableRows rows;
  read_table_rows(keys, {"x", "y"}, "length", rows);
  if (rows.values.empty()) return;
  table.file = std::move(rows.file);
  table.times = std::move(rows.times);
  table.x = std::move(rows.values[0]);
  table.y = std::move(rows.values[1]);
}

// The reference at that key, if it is there.
template <class Rule, class Kind>
void read_kind(Keys& keys, std::string_view key, const Rule& rule, Kind kind,
               Reference& reference) {
  if (const std::optional<Value> value = keys.find(key)) {
    rule.read(*value, kind);
    reference = std::move(kind);
  }
}

struct PointRule : PairOf {
  PointRule() : PairOf{Dimension::length} {}
  bool read(const Value& value, PointReference& into) const {
    return PairOf::read(value, into.position);
  }
};

}  // namespace

void read_reference(Keys& keys, Reference& reference) {
  keys.exactly_one({"circle", "point", "lissajous", "waypoints", "table"});
  read_kind(keys, "circle", MappingOf(read_circle), CircleReference{}, reference);
  read_kind(keys, "point", PointRule{}, PointReference{}, reference);
  read_kind(keys, "lissajous", MappingOf(read_lissajous), LissajousReference{}, reference);
  read_kind(keys, "waypoints", MappingOf(read_waypoints), WaypointReference{}, reference);
  read_kind(keys, "table", MappingOf(read_table), TableReference{}, reference);
}

}  // namespace bbsim::input
