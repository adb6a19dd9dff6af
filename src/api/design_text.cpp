// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/design_text.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "api/version.hpp"
#include "base/json.hpp"
#include "base/quoted.hpp"
#include "base/short_number.hpp"
#include "record/aligned.hpp"

namespace bbsim::api {
namespace {

using Json = nlohmann::ordered_json;
using design::Designed;
using design::Plays;
using design::Task;

constexpr double degrees_per_radian = 57.29577951308232;

std::string deviation_text(std::optional<double> sd) {
  return sd && std::isfinite(*sd) ? record::rounded(*sd) : "-";
}

Json deviation_json(std::optional<double> sd) {
  return sd && std::isfinite(*sd) ? Json(*sd) : Json(nullptr);
}

bool is_told(const design::Expected& one) {
  return std::isfinite(one.sd);
}

std::string in_degrees(const Pair& of, const std::string& unit) {
  const std::string phi = rounded(of[0] * degrees_per_radian, 3);
  const std::string theta = rounded(of[1] * degrees_per_radian, 3);
  return (phi == theta ? phi : phi + " and " + theta) + " " + unit;
}

std::string percent(double share) {
  return rounded(100 * share, 3) + " %";
}

std::string start_text(const Designed& designed) {
  const Pair& at = designed.motion.position;
  return "begin with the ball at rest at x = " + short_number(100 * at[0]) +
         " cm, y = " + short_number(100 * at[1]) + " cm";
}

std::string limits_text(const Task& task, const Designed& designed) {
  const design::Limits& limits = task.limits;
  std::vector<std::vector<std::string>> lines{{"limit", "of", "used", "from"}};
  const auto length = [](double m) { return rounded(100 * m, 4); };
  lines.push_back({"ball from the center",
                   limits.rectangle ? length((*limits.rectangle)[0]) + " and " +
                                          length((*limits.rectangle)[1]) + " cm"
                                    : length(*limits.disc) + " cm",
                   percent(designed.use.greatest_edge()), "plate and margin"});
  std::string tilt = in_degrees(limits.tilt, "deg");
  if (limits.total_tilt) {
    tilt += ", in all " + rounded(*limits.total_tilt * degrees_per_radian, 3) + " deg";
  }
  lines.push_back({"tilt", tilt, percent(designed.use.greatest_tilt()), limits.tilt_from});
  lines.push_back({"tilt rate", in_degrees(limits.tilt_rate, "deg/s"),
                   percent(designed.use.greatest_tilt_rate()), limits.tilt_rate_from});
  if (limits.friction) {
    lines.push_back({"friction that rolling needs", short_number(*limits.friction),
                     percent(designed.use.friction), "events.slip"});
  }
  return record::aligned(lines);
}

}  // namespace

std::string report_of(const Task& task, const Designed& designed) {
  std::vector<std::vector<std::string>> keys{
      {"standard deviation", "value", "designed", "circle", "step", "unit"}};
  for (const design::Expected& one : designed.parameters) {
    keys.push_back({one.key, short_number(one.value), deviation_text(one.sd),
                    deviation_text(one.circle), deviation_text(one.step),
                    one.unit.empty() ? "1" : one.unit});
  }
  std::string text = record::aligned(keys) + "\n" + limits_text(task, designed) + "\n";
  text += short_number(task.length) + " s at " + short_number(task.rate) +
          " Hz: " + std::to_string(designed.numbers) + " numbers in " +
          std::to_string(designed.windows) + (designed.windows == 1 ? " window" : " windows") +
          "; noise";
  for (std::size_t c = 0; c < task.columns.size(); ++c) {
    const std::string unit(task.columns[c]->unit);
    text += (c == 0 ? " " : ", ") + std::string(task.columns[c]->name) + " " +
            record::rounded(task.noise[c]) + (unit.empty() ? "" : " " + unit);
  }
  text += "\nbest of " + std::to_string(designed.tried) + " motions";
  if (designed.circle_frequency) {
    constexpr double turn = 6.283185307179586;
    text += "; the best circle has " + record::rounded(*designed.circle_frequency / turn) + " Hz";
  }
  text += "\n" + start_text(designed) + "\n";
  for (const design::Expected& one : designed.parameters) {
    if (is_told(one)) continue;
    text += "not identifiable: " + one.key +
            ", which a log of this length cannot separate from the other keys and the windows' "
            "starts\n";
  }
  return text;
}

std::string json_of(const Task& task, const Designed& designed) {
  Json json;
  json["parameters"] = Json::array();
  for (const design::Expected& one : designed.parameters) {
    json["parameters"].push_back({{"key", one.key},
                                  {"value", one.value},
                                  {"sd", deviation_json(one.sd)},
                                  {"circle_sd", deviation_json(one.circle)},
                                  {"step_sd", deviation_json(one.step)}});
  }
  json["length"] = task.length;
  json["rate"] = task.rate;
  json["noise"] = Json::object();
  for (std::size_t c = 0; c < task.columns.size(); ++c) {
    json["noise"][std::string(task.columns[c]->name)] = task.noise[c];
  }
  json["used"] = {{"edge", designed.use.greatest_edge()},
                  {"tilt", designed.use.greatest_tilt()},
                  {"tilt_rate", designed.use.greatest_tilt_rate()}};
  if (task.limits.friction) json["used"]["friction"] = designed.use.friction;
  json["position"] = designed.motion.position;
  json["sines"] = Json::object();
  const char* const names[2][2] = {{"phi", "theta"}, {"x", "y"}};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    Json sines = Json::array();
    for (const Sinusoid& sine : designed.motion.sines[axis]) {
      sines.push_back(
          {{"amplitude", sine.amplitude}, {"frequency", sine.frequency}, {"phase", sine.phase}});
    }
    json["sines"][names[task.plays == Plays::tilts ? 0 : 1][axis]] = sines;
  }
  json["identifiable"] = std::ranges::all_of(designed.parameters, is_told);
  return json_text(json, 2) + '\n';
}

std::string comments_of(const DesignRequest& request, const Task& task, const Designed& designed) {
  std::string text = "# Designed by bbsim " + std::string(version()) + ": plays " +
                     shown(request.table) + ", " + short_number(task.length) + " s; " +
                     start_text(designed) + "\n# Standard deviations to expect from a fit:\n";
  for (const design::Expected& one : designed.parameters) {
    text += "#   " + one.key + ": " + deviation_text(one.sd) +
            (one.unit.empty() || !is_told(one) ? "" : " " + one.unit) + "\n";
  }
  return text;
}

}  // namespace bbsim::api
