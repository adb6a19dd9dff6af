// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/design.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "api/design_text.hpp"
#include "api/fit_text.hpp"
#include "base/number_text.hpp"
#include "base/quoted.hpp"
#include "base/text.hpp"
#include "design/player.hpp"
#include "scenario/columns.hpp"
#include "scenario/edit_text.hpp"
#include "scenario/value_in.hpp"

namespace bbsim::api {
namespace {

using design::Plays;
using Settings = std::vector<ScenarioFamily::Setting>;

constexpr double most_rows_of_log = 100'000;

double size_given(const std::string& option, const std::string& text, const char* unit,
                  const char* allowed) {
  const auto value = scenario::value_in(text, unit);
  if (value && *value > 0) return *value;
  throw InputError(option + ": found " + bbsim::quoted(text) + "; allowed: " + allowed);
}

std::optional<double> size_if_given(const std::string& option, const std::string& text,
                                    const char* unit, const char* allowed) {
  if (text.empty()) return {};
  return size_given(option, text, unit, allowed);
}

Plays what_is_played(const Scenario& scenario) {
  if (scenario.gimbal.motion || commands_of(scenario) != nullptr) return Plays::tilts;
  if (!scenario.controller) {
    throw InputError(
        "gimbal.torque: found, which a design cannot choose; allowed: gimbal.motion, or a "
        "controller with a reference");
  }
  if (scenario.controller->own) {
    throw InputError(
        "controller: found a program or library of your own; allowed in a design: a law of bbsim, "
        "controller.commands, or gimbal.motion");
  }
  return Plays::reference;
}

double rate_of(const DesignRequest& request, const Scenario& scenario) {
  if (request.rate) {
    if (*request.rate > 0) return *request.rate;
    throw InputError("--rate: found " + number_text(*request.rate) +
                     "; allowed: rows per second, such as 50");
  }
  constexpr double usual = 50;
  if (!scenario.controller || !scenario.controller->sampling) return usual;
  const auto& sensor = scenario.controller->sensor;
  const double period =
      sensor && sensor->period ? *sensor->period : scenario.controller->sampling->period;
  // Boards and sensors exchange values more often than a log has rows.
  constexpr double most = 200;
  return std::min(1 / period, most);
}

// Rounds the length to a whole number of rows.
double length_of(const DesignRequest& request, const Scenario& scenario, double rate) {
  const double asked =
      request.length.empty()
          ? scenario.time.end
          : size_given("--length", request.length, "s", "a time greater than 0, such as \"10 s\"");
  const double rows = std::round(asked * rate);
  constexpr double fewest = 16;
  if (rows >= fewest && rows <= most_rows_of_log) return rows / rate;
  throw InputError("--length: found " + number_text(asked) + " s at " + number_text(rate) +
                   " Hz; allowed: a log of " + std::to_string(std::lround(fewest)) + " to " +
                   std::to_string(std::lround(most_rows_of_log)) + " rows");
}

void read_noise(const DesignRequest& request, const Scenario& scenario, design::Task& task) {
  double usual = 1e-3;
  if (scenario.controller && scenario.controller->sensor) {
    const Sensor& sensor = *scenario.controller->sensor;
    // Rounding to counts acts like a uniformly distributed error.
    const double own = std::hypot(sensor.noise, sensor.resolution / std::sqrt(12.0));
    if (own > 0) usual = own;
  }
  for (const char* const name : {"x", "y"}) {
    if (!task.axes[task.columns.size()] && scenario.ball.groove) continue;
    task.columns.push_back(scenario::find_column(name));
    task.noise.push_back(usual);
  }
  for (const std::string& text : request.noise) {
    const std::size_t equals = text.find('=');
    const std::string name(trimmed(std::string_view(text).substr(0, equals)));
    const scenario::Column* const column = scenario::find_column(name);
    const auto size =
        equals == std::string::npos || column == nullptr
            ? std::nullopt
            : scenario::value_in(trimmed(std::string_view(text).substr(equals + 1)), column->unit);
    if (!size || !(*size > 0) || name == "t") {
      throw InputError("--noise: found " + bbsim::quoted(text) +
                       "; allowed: COLUMN=SIZE, a column of `bbsim columns` and a standard "
                       "deviation greater than 0, such as x=0.5mm");
    }
    if (const scenario::Missing missing = scenario::missing(*column, scenario)) {
      throw InputError("--noise: found " + name + ", " + missing.why +
                       "; allowed: columns that the scenario has");
    }
    const auto known = std::ranges::find(task.columns, column);
    const auto place = static_cast<std::size_t>(known - task.columns.begin());
    if (known == task.columns.end()) {
      task.columns.push_back(column);
      task.noise.push_back(0);
    }
    task.noise[place] = *size;
  }
}

// Table for one axis of `section`, with the scale, offset and delay of the scenario's own table.
std::string table_text(const ScenarioFamily& family, const std::string& section,
                       const std::string& axis, const std::string& file) {
  std::string text = "{table: {file: " + file + ", time: t, value: " + axis + ", unit: rad";
  for (const char* const name : {"scale", "offset", "delay"}) {
    const auto value = family.number_at(section + "." + axis + ".table." + std::string(name), {});
    if (value) text += ", " + std::string(name) + ": " + number_text(*value);
  }
  return text + "}}";
}

// The input that the experiment plays, and how it is logged.
struct Plan {
  Plays plays;
  std::string section;  // has the tables of tilts
  std::array<bool, 2> axes;
  double length, rate;
  bool is_launched;  // whether the scenario's ball moves at the start
};

// Settings that make the scenario play the table.
Settings settings_of(const DesignRequest& request, const Plan& plan, const Pair& start) {
  std::string file = "'";
  for (const char c : request.table) file += c == '\'' ? "''" : std::string(1, c);
  file += "'";
  Settings settings;
  if (plan.plays == Plays::tilts) {
    const auto axis = [&](std::size_t i, const char* name) {
      return plan.axes[i] ? table_text(request.family, plan.section, name, file) : std::string("0");
    };
    settings.push_back(
        {plan.section, "{phi: " + axis(0, "phi") + ", theta: " + axis(1, "theta") + "}"});
  } else {
    settings.push_back(
        {"controller.reference", "{table: {file: " + file + ", time: t, x: x, y: y, unit: m}}"});
  }
  settings.push_back(
      {"ball.position", "[" + number_text(start[0]) + ", " + number_text(start[1]) + "]"});
  if (plan.is_launched) settings.push_back({"ball.velocity", "[0, 0]"});
  settings.push_back({"time.end", number_text(plan.length)});
  settings.push_back({"time.step", number_text(1 / plan.rate)});
  return settings;
}

ScenarioFamily family_with(const Source& source, const Settings& settings) {
  Source changed = source;
  for (const auto& [key, value] : settings) changed.overrides.push_back(key + "=" + value);
  return ScenarioFamily(changed);
}

std::array<const char*, 2> names_played(Plays plays) {
  return plays == Plays::tilts ? std::array{"phi", "theta"} : std::array{"x", "y"};
}

file::TableData placeholder_table(Plays plays, double length) {
  const auto [times, values] = design::placeholder(length);
  const auto names = names_played(plays);
  return {{"t", names[0], names[1]}, {times, values, values}};
}

// Rounds to steps too small for any rig, so that the text is short.
double in_steps(double value) {
  constexpr double steps = 1e8;
  const double rounded = std::round(value * steps) / steps;
  return rounded == 0 ? 0 : rounded;  // no -0
}

file::TableData rows_of(const design::Task& task, const design::Designed& designed) {
  const auto names = names_played(task.plays);
  file::TableData table{{"t", names[0], names[1]}, {{}, {}, {}}};
  const double count = std::round(task.length * task.rate);
  for (double i = 0; i <= count; ++i) {
    const double t = i / task.rate;
    table.columns[0].push_back(t);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      table.columns[1 + axis].push_back(
          task.axes[axis]
              ? in_steps(design::command(designed.motion, axis, designed.nominal[axis], t))
              : 0);
    }
  }
  return table;
}

std::string csv_of(const file::TableData& table) {
  std::string text;
  for (const std::string& name : table.names) text += (text.empty() ? "" : ",") + name;
  text += '\n';
  for (std::size_t row = 0; row < table.columns.front().size(); ++row) {
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      text += (c == 0 ? "" : ",") + number_text(table.columns[c][row]);
    }
    text += '\n';
  }
  return text;
}

}  // namespace

DesignResult design(const DesignRequest& request, DesignParts parts, Watch& watch) {
  const Scenario scenario = request.family.read({});
  for (const std::string& remark : scenario.remarks) watch.note(remark);
  const Plays plays = what_is_played(scenario);
  if (parts.sketch && plays == Plays::reference) {
    throw InputError(
        "--sketch: the scenario has a controller with a reference; allowed: with gimbal.motion or "
        "controller.commands, whose tilts a sketch can play; --table writes the reference for your "
        "own firmware");
  }
  std::array<bool, 2> axes{true, true};
  if (scenario.ball.groove)
    axes = {scenario.ball.groove->axis == 0, scenario.ball.groove->axis == 1};
  const double rate = rate_of(request, scenario);
  const double length = length_of(request, scenario, rate);
  const char* const section =
      commands_of(scenario) != nullptr ? "controller.commands" : "gimbal.motion";
  const Plan plan{plays, section, axes, length, rate, scenario.ball.velocity != Pair{0, 0}};
  const auto settings = [&](const Pair& start) { return settings_of(request, plan, start); };
  ScenarioFamily family = family_with(request.family.source(), settings({0, 0}));
  family.give_table(request.table, placeholder_table(plays, length));

  design::Task task{family};
  task.plays = plays;
  task.axes = axes;
  task.keys = fit::read_free_keys(request.free, family);
  read_noise(request, scenario, task);
  task.window = size_if_given("--window", request.window, "s",
                              "a time greater than 0, such as 2 or \"500 ms\"");
  task.length = length;
  task.rate = rate;
  design::LimitChoice choice;
  choice.tilt = size_if_given("--max-tilt", request.tilt, "rad",
                              "an angle greater than 0, such as \"8 deg\"");
  choice.tilt_rate = size_if_given("--max-tilt-rate", request.tilt_rate, "rad/s",
                                   "a rate greater than 0, such as \"60 deg/s\"");
  choice.margin =
      size_if_given("--margin", request.margin, "m", "a length greater than 0, such as \"3 cm\"");
  task.limits = design::limits_of(scenario, choice);
  const auto played = [&](const Pair& start) {
    return edited_scenario(request.family.source(), "", settings(start));
  };
  if (parts.scenario) static_cast<void>(played({0, 0}));  // fails now if the text cannot be written
  task.threads = request.threads;
  task.stop = watch.stop();
  task.progress = [&watch](double fraction, const std::string& detail) {
    watch.update(fraction, detail);
  };

  DesignResult made;
  file::TableData table;
  const auto written = [&](const design::Designed& designed) {
    table = rows_of(task, designed);
    const Pair& start = designed.motion.position;
    ScenarioFamily plays_it =
        parts.scenario ? ScenarioFamily(Source{request.family.source().file, played(start), {}})
                       : family_with(request.family.source(), settings(start));
    plays_it.give_table(request.table, table);
    return plays_it;
  };
  watch.start(0);
  made.designed = design::design(task, written);
  watch.end();
  if (made.designed.interrupted) {
    made.code = ExitCode::interrupted;
    return made;
  }
  made.text = report_of(task, made.designed);
  made.json = json_of(task, made.designed);
  made.table = csv_of(table);
  if (parts.scenario)
    made.scenario =
        comments_of(request, task, made.designed) + played(made.designed.motion.position);
  if (parts.sketch) {
    made.sketch = design::player_sketch(
        {rate, table.columns[1], table.columns[2], made.designed.motion.position});
  }
  return made;
}

}  // namespace bbsim::api
