// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "record/summary.hpp"

#include <nlohmann/json.hpp>

#include "base/json.hpp"
#include "base/number_text.hpp"

namespace bbsim::record {
namespace {

// The members of each part, once for both formats.
Json members_of(const RunSummary& summary) {
  Json json = {{"version", summary.version},
               {"instruction_set", summary.instruction_set},
               {"scenario", summary.scenario},
               {"title", summary.title},
               {"overrides", summary.overrides},
               {"status", summary.status},
               {"reason", summary.reason},
               {"reason_code", summary.reason_code},
               {"warnings", summary.warnings},
               {"end_time", summary.end_time},
               {"rows", summary.rows},
               {"output", summary.output},
               {"states", summary.states},
               {"model_notes", summary.model_notes},
               {"method", summary.method},
               {"rtol", summary.rtol},
               {"atol", summary.atol}};
  if (summary.error_bound) json["error_bound"] = *summary.error_bound;
  if (summary.error_estimate) json["error_estimate"] = *summary.error_estimate;
  return json;
}

Json members_of(const RunSummary::Statistics& statistics) {
  return {{"steps", statistics.steps},
          {"rhs_evaluations", statistics.rhs_evaluations},
          {"jacobian_evaluations", statistics.jacobian_evaluations},
          {"nonlinear_iterations", statistics.nonlinear_iterations},
          {"error_test_failures", statistics.error_test_failures},
          {"cpu_seconds", statistics.cpu_seconds}};
}

Json members_of(const MotorPeaks& peaks) {
  return {{"peak_torque_phi", peaks.torque_phi.value},
          {"peak_torque_phi_at", peaks.torque_phi.at},
          {"peak_torque_theta", peaks.torque_theta.value},
          {"peak_torque_theta_at", peaks.torque_theta.at},
          {"peak_power", peaks.power.value},
          {"peak_power_at", peaks.power.at}};
}

Json members_of(const model::Occurrence& event) {
  const model::BallMotion& ball = event.sample.ball;
  const model::GimbalState& gimbal = event.sample.gimbal;
  return {{"t", event.t},
          {"event", event.name},
          {"action", event.stopped ? "stop" : "note"},
          {"x", ball.x},
          {"y", ball.y},
          {"vx", ball.x_dot},
          {"vy", ball.y_dot},
          {"spin", ball.gamma_dot},
          {"phi", gimbal.phi},
          {"theta", gimbal.theta},
          {"phi_rate", gimbal.phi_dot},
          {"theta_rate", gimbal.theta_dot}};
}

Json members_of(const UnreliableRecord& record) {
  return {{"key", record.key}, {"column", record.column}, {"time", record.time}};
}

Json members_of(const ExpectationRecord& record) {
  return {{"text", record.text}, {"value", record.value}, {"holds", record.holds}};
}

template <class Records, class Make>
Json list_of(const Records& records, const Make& make) {
  Json list = Json::array();
  for (const auto& record : records) list.push_back(make(record));
  return list;
}

// "t=0.54 event=edge action=stop x=0.16 y=-0.02"
std::string words_of(const Json& members) {
  std::string line;
  for (const auto& [name, value] : members.items()) {
    line += (line.empty() ? "" : " ") + name + '=';
    line += value.is_string() ? value.get<std::string>() : number_text(value.get<double>());
  }
  return line;
}

}  // namespace

file::AttributeValue attribute_of(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_float()) return value.get<double>();
  if (value.is_number()) return value.get<std::size_t>();
  std::string lines;
  for (const Json& line : value) lines += (lines.empty() ? "" : "\n") + line.get<std::string>();
  return lines;
}

std::string to_json(const RunSummary& summary) {
  const auto members = [](const auto& record) { return members_of(record); };
  Json json = members_of(summary), measures = Json::object(), gradients = Json::object();
  if (summary.peaks) {
    json["motors"] = members_of(*summary.peaks);
    json["motors"]["carries"] = summary.peaks->with_plate ? "ball and plate" : "ball";
  }
  for (const auto& [name, value] : summary.measures) measures[name] = value;
  if (!measures.empty()) json["measures"] = std::move(measures);
  for (const auto& [measure, by_key] : summary.gradients) {
    for (const auto& [key, value] : by_key) gradients[measure][key] = value;
  }
  if (!gradients.empty()) json["gradients"] = std::move(gradients);
  if (summary.unreliable) json["unreliable"] = list_of(*summary.unreliable, members);
  if (!summary.expectations.empty()) json["expectations"] = list_of(summary.expectations, members);
  json["events"] = list_of(summary.events, members);
  json["statistics"] = members_of(summary.statistics);
  json["scenario_text"] = summary.scenario_text;
  constexpr int indent = 2;
  return json_text(json, indent) + "\n";
}

file::Attributes to_attributes(const RunSummary& summary, const std::string& scenario_text) {
  file::Attributes attributes;
  const auto add = [&](const std::string& name, const Json& value) {
    // Equal runs give the same bytes, even with other output files and durations.
    if (name != "output" && name != "cpu_seconds")
      attributes.emplace_back(name, attribute_of(value));
  };
  const auto add_all = [&](const Json& members) {
    for (const auto& [name, value] : members.items()) add(name, value);
  };
  const auto words = [](const auto& record) { return words_of(members_of(record)); };
  add_all(members_of(summary));
  add_all(members_of(summary.statistics));
  if (summary.peaks) add_all(members_of(*summary.peaks));
  for (const auto& [name, value] : summary.measures) add("measure " + name, value);
  for (const auto& [measure, by_key] : summary.gradients) {
    for (const auto& [key, value] : by_key) {
      add("gradient d(" + measure + ")/d(" + key + ")", value);
    }
  }
  if (summary.unreliable) add("unreliable", list_of(*summary.unreliable, words));
  if (!summary.expectations.empty()) {
    add("expectations", list_of(summary.expectations, [](const ExpectationRecord& expectation) {
          return expectation.text + (expectation.holds ? ": holds, " : ": does not hold, ") +
                 number_text(expectation.value);
        }));
  }
  add("events", list_of(summary.events, words));
  add("scenario_text", scenario_text);
  return attributes;
}

}  // namespace bbsim::record
