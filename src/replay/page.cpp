// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "replay/page.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/json.hpp"
#include "replay/kept.hpp"
#include "replay/numbers.hpp"
#include "replay/template.hpp"
#include "scenario/columns.hpp"

namespace bbsim::replay {
namespace {

constexpr std::size_t most_rows = 20000;
constexpr std::size_t most_bytes = 2'400'000;
constexpr std::size_t most_cases = 40000;
constexpr std::size_t most_sweep_numbers = 320000;
constexpr std::size_t most_events = 2000;

template <class Value>
std::vector<Value> picked(const std::vector<Value>& values, const std::vector<std::size_t>& rows) {
  std::vector<Value> result;
  result.reserve(rows.size());
  for (const std::size_t row : rows) result.push_back(values[row]);
  return result;
}

Json columns_json(const Run& run, const std::vector<std::size_t>& rows, const Numbers& numbers) {
  Json columns = Json::array();
  for (const file::Column& series : run.columns) {
    if (series.name == "t") continue;
    const scenario::Column* const known = scenario::find_column(series.name);
    columns.push_back({{"name", series.name},
                       {"unit", series.unit},
                       {"meaning", known == nullptr ? "" : known->meaning},
                       {"data", numbers.floats(picked(series.numbers, rows))}});
  }
  return columns;
}

// Plots of the columns in scenario::catalogue, with the style of each curve. Commands appear in
// several plots, in the unit of each.
Json plots_json() {
  constexpr const char* roles[] = {"main", "reference", "measured", "command"};
  Json plots = Json::array();
  for (const std::string_view title : scenario::plots) {
    Json columns = Json::array();
    const auto add = [&](const scenario::Column& column, std::string_view unit) {
      columns.push_back({{"name", column.name},
                         {"symbol", column.symbol},
                         {"unit", unit},
                         {"role", roles[static_cast<int>(column.role)]},
                         {"axis", scenario::axis_of(column.name)}});
    };
    for (const scenario::Panel& panel : scenario::panels) {
      if (panel.plot != title) continue;
      const auto add_if_here = [&](const scenario::Column& column) {
        if (column.needs != scenario::Needs::commands) {
          if (column.panel == panel.name) add(column, column.unit);
          return;
        }
        for (const Drives drives :
             {Drives::angle, Drives::acceleration, Drives::torque, Drives::voltage}) {
          const std::string_view unit = command_unit(drives);
          if (&scenario::panel_of(column, unit) == &panel) add(column, unit);
        }
      };
      std::ranges::for_each(scenario::catalogue, add_if_here);
      add_if_here(scenario::position_error);
    }
    plots.push_back({{"title", title}, {"columns", std::move(columns)}});
  }
  return plots;
}

template <class Point>
std::vector<double> one_list(const std::vector<Point>& points) {
  std::vector<double> parts;
  for (const Point& point : points) parts.insert(parts.end(), point.begin(), point.end());
  return parts;
}

// Times that equal start + i * step bit for bit need only three numbers; others are all listed.
Json times_json(const std::vector<double>& t, const Numbers& numbers) {
  const double start = t.front(), step = t.size() > 1 ? t[1] - t[0] : 0;
  bool even = true;
  for (std::size_t i = 0; i < t.size(); ++i) {
    even = even && t[i] == start + static_cast<double>(i) * step;
  }
  if (even) return {{"start", start}, {"step", step}, {"count", t.size()}};
  return numbers.doubles(t);
}

Json events_json(const Run& run) {
  Json events = Json::array();
  // Keeps the first events and the last one, which may have stopped the run.
  for (std::size_t i = 0; i < run.events.size(); ++i) {
    if (i + 1 >= most_events && i + 1 < run.events.size()) continue;
    const results::Event& event = run.events[i];
    events.push_back({{"t", event.t},
                      {"name", event.name},
                      {"action", event.stopped ? "stop" : "note"},
                      {"x", event.x},
                      {"y", event.y}});
  }
  return events;
}

Json poles_json(const Poles& poles) {
  Json values = Json::array();
  for (const auto& pole : poles.values) values.push_back({pole.real(), pole.imag()});
  return {{"period", poles.period ? Json(*poles.period) : Json()}, {"values", values}};
}

Json legs_json(const ThreeServoPlate& plate, const Mounting& mounting) {
  Json legs = Json::array();
  for (std::size_t i = 0; i < 3; ++i) {
    const ServoLeg leg = plate.leg(i);
    legs.push_back({{"angle", leg.angle},
                    {"base", leg.radius_base},
                    {"plate", leg.radius_plate},
                    {"horn", leg.horn},
                    {"rod", leg.rod},
                    {"height", leg.height},
                    {"joint", leg.joint_height},
                    {"offset", leg.offset},
                    {"direction", leg.direction}});
  }
  return {
      {"legs", legs}, {"phiOffset", mounting.phi_offset}, {"thetaOffset", mounting.theta_offset}};
}

// The push rods of phi and theta; null if there is none.
Json push_rods_json(const Gimbal& gimbal) {
  const double zero[] = {gimbal.mounting.phi_offset, gimbal.mounting.theta_offset};
  Json rods = Json::array();
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto& linkage = gimbal.linkage[axis];
    const auto* const its = linkage ? std::get_if<RodLinkage>(&*linkage) : nullptr;
    rods.push_back(nullptr);
    if (its == nullptr) continue;
    const double fits = std::hypot(its->offset[0] + its->arm - its->horn, its->offset[1]);
    rods.back() = {{"horn", its->horn},
                   {"arm", its->arm},
                   {"rod", its->rod.value_or(fits)},
                   {"offset", its->offset},
                   {"zero", zero[axis]}};
  }
  return rods;
}

Json source_json(const Source& source) {
  return {{"file", source.file}, {"text", source.text}, {"overrides", source.overrides}};
}

Json run_json(const Run& run, const Stage& stage, std::size_t most, const Numbers& numbers) {
  static const Scenario unknown;
  const Scenario& scenario = run.scenario ? *run.scenario : unknown;
  const Mounting& mounting = scenario.gimbal.mounting;
  const double radius = ball_radius(run).value_or(stage.ball_radius);
  const std::vector<Quaternion> orientation = orientation_of(run, radius);
  const KeptRows kept = kept_rows(run, orientation, most);
  Json json = {{"name", run.name},         {"title", run.title},
               {"status", run.status},     {"reason", run.reason},
               {"end", scenario.time.end}, {"rows", rows_of_file(run)},
               {"buckets", kept.buckets},  {"motionError", kept.motion_error}};
  json["ball"] = {{"radius", radius}, {"given", run.scenario.has_value()}};
  json["mounting"] = {{"height", mounting.height},
                      {"skew", mounting.skew},
                      {"yaw", mounting.yaw},
                      {"baseTilt", mounting.base_tilt}};
  const auto& three = scenario.gimbal.three_servos;
  if (three) json["legs"] = legs_json(*three, mounting);
  json["rods"] = push_rods_json(scenario.gimbal);
  json["time"] = times_json(picked(run.find("t")->numbers, kept.rows), numbers);
  json["columns"] = columns_json(run, kept.rows, numbers);
  json["orientation"] =
      numbers.parts(one_list(orientation.empty() ? orientation : picked(orientation, kept.rows)));
  json["orientationGiven"] = !run.orientation.empty();
  json["reached"] = run.end_time ? Json(*run.end_time) : Json();
  json["hasEndRow"] = run.has_end_row;
  json["unitsKnown"] = run.units_known;
  json["events"] = events_json(run);
  json["eventCount"] = run.events.size();
  json["reference"] = numbers.floats(one_list(run.reference));
  const auto& slip = scenario.events.slip;
  json["friction"] = slip ? Json(slip->friction) : Json();
  json["scenario"] = source_json(scenario.source);
  json["summary"] = run.summary.empty() ? Json() : parse_json(run.summary);
  json["check"] = run.check;
  json["poles"] = run.poles ? poles_json(*run.poles) : Json();
  json["version"] = run.version;
  return json;
}

Json sweep_column_json(const SweepColumn& column, const std::vector<std::size_t>& cases, bool exact,
                       const Numbers& numbers) {
  Json json = {{"name", column.name}, {"unit", column.unit}};
  if (!column.texts.empty()) {
    json["words"] = picked(column.texts, cases);
  } else {
    std::vector<double> values = picked(column.numbers, cases);
    json[exact ? "doubles" : "floats"] =
        exact ? numbers.doubles(std::move(values)) : numbers.floats(std::move(values));
  }
  return json;
}

Json sweep_json(const Sweep& sweep, std::size_t sweeps, const Numbers& numbers) {
  const std::size_t of_case = 2 * sweep.keys.size() + sweep.measures.size() + 1;
  const std::vector<std::size_t> cases = cases_kept(
      sweep, std::max<std::size_t>(1, std::min(most_cases, most_sweep_numbers / of_case) / sweeps));
  Json json = {{"name", sweep.name}, {"title", sweep.title}, {"cases", sweep.status.size()}};
  json["numbers"] = numbers.doubles(picked(sweep.cases, cases));
  // Most cases end alike. Lists each ending once, and its index for every case.
  std::vector<std::string> ways;
  Json status = Json::array();
  for (const std::size_t i : cases) {
    const auto found = std::find(ways.begin(), ways.end(), sweep.status[i]);
    status.push_back(found - ways.begin());
    if (found == ways.end()) ways.push_back(sweep.status[i]);
  }
  json["statuses"] = ways;
  json["status"] = status;
  Json keys = Json::array(), measures = Json::array();
  for (const SweepColumn& key : sweep.keys) {
    keys.push_back(sweep_column_json(key, cases, true, numbers));
    if (key.drawn) keys.back()["drawn"] = true;
    if (!key.along.empty()) keys.back()["along"] = key.along;
  }
  for (const SweepColumn& measure : sweep.measures) {
    measures.push_back(sweep_column_json(measure, cases, false, numbers));
  }
  json["keys"] = std::move(keys);
  json["measures"] = std::move(measures);
  json["scenario"] = source_json(sweep.source);
  return json;
}

Json loops_json(const std::optional<Live::Loops>& maybe, const Numbers& numbers) {
  if (!maybe) return nullptr;
  const Live::Loops& loops = *maybe;
  Json curves = Json::object();
  for (const auto& [command, gain, phase] : loops.curves) {
    curves[command] = {{"gain", numbers.floats(gain)}, {"phase", numbers.floats(phase)}};
  }
  return {{"stable", loops.stable},
          {"period", loops.period ? Json(*loops.period) : Json()},
          {"frequencies", numbers.floats(loops.frequencies)},
          {"curves", curves},
          {"margins", parse_json(loops.margins)}};
}

Json live_json(const Live& live, const Numbers& numbers) {
  const auto bound = [](const std::optional<double>& value) {
    return value ? Json(*value) : Json();
  };
  Json keys = Json::array(), tasks = Json::array();
  for (const LiveKey& key : live.keys) {
    keys.push_back({{"key", key.key},
                    {"text", key.text},
                    {"unit", key.unit},
                    {"value", key.value},
                    {"least", bound(key.least)},
                    {"most", bound(key.most)},
                    {"open", key.open},
                    {"whole", key.whole},
                    {"meaning", key.meaning}});
  }
  for (const Live::Task& task : live.tasks) {
    tasks.push_back({{"text", task.text}, {"expect", task.expect}, {"holds", task.holds}});
  }
  Json measures = Json::object();
  for (const Live::Measure& one : live.measures) {
    measures[one.name] = {{"value", one.value}, {"unit", one.unit}};
  }
  return {{"keys", keys},
          {"free", live.free},
          {"tasks", tasks},
          {"measures", measures},
          {"loops", loops_json(live.loops, numbers)}};
}

Json json_of(const Scene& scene, const Numbers& numbers) {
  Json json = {{"format", 1}, {"version", scene.version}, {"title", scene.title}};
  Json runs = Json::array(), sweeps = Json::array();
  if (!scene.runs.empty()) {
    const Stage stage = stage_of(scene);
    json["stage"] = {{"width", stage.width},
                     {"depth", stage.depth},
                     {"round", stage.round},
                     {"plateGiven", stage.plate_given},
                     {"largest", largest_drawn}};
    for (const Run& run : scene.runs) {
      runs.push_back(run_json(run, stage, rows_allowed(scene), numbers));
    }
  }
  for (const Sweep& sweep : scene.sweeps)
    sweeps.push_back(sweep_json(sweep, scene.sweeps.size(), numbers));
  json["plots"] = plots_json();
  json["runs"] = std::move(runs);
  json["sweeps"] = std::move(sweeps);
  if (scene.live) json["live"] = live_json(*scene.live, numbers);
  return json;
}

// Removes the parts of the template between <!--NAME--> and <!--/NAME-->. A sweep, for example,
// needs no three.js.
std::string without(const std::string& name, std::string text) {
  const std::string begin = "<!--" + name + "-->", end = "<!--/" + name + "-->";
  for (std::size_t from = text.find(begin); from != std::string::npos; from = text.find(begin)) {
    const std::size_t to = text.find(end, from);
    if (to == std::string::npos) break;
    text.erase(from, to + end.size() - from);
  }
  return text;
}

}  // namespace

std::size_t rows_allowed(const Scene& scene) {
  // The bytes of a row in the run with the most columns: time, other columns, orientation.
  std::size_t bytes = 1;
  for (const Run& run : scene.runs) {
    bytes = std::max(bytes, sizeof(double) + (run.columns.size() + 1) * sizeof(float));
  }
  const std::size_t runs = std::max<std::size_t>(scene.runs.size(), 1);
  return std::max<std::size_t>(std::min(most_rows, most_bytes / bytes) / runs, 100);
}

std::string page(const Scene& scene, std::string_view whole_template, std::string_view engine) {
  check_scene(scene);
  std::string needed = without(engine.empty() ? "live" : "still", std::string(whole_template));
  if (!engine.empty()) needed = with_engine(std::move(needed), engine);
  if (scene.runs.empty()) needed = without("runs", std::move(needed));
  if (scene.sweeps.empty() && engine.empty()) needed = without("sweeps", std::move(needed));
  const Json json = json_of(scene, Numbers(nullptr));
  return filled(needed, scene.title, json_text(json));
}

std::string scene_json(const Scene& scene, std::vector<std::vector<double>>& arrays) {
  check_scene(scene);
  return json_text(json_of(scene, Numbers(&arrays)));
}

std::string loops_json(const std::optional<Live::Loops>& loops,
                       std::vector<std::vector<double>>& arrays) {
  return json_text(loops_json(loops, Numbers(&arrays)));
}

}  // namespace bbsim::replay
