// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "record/summary.hpp"

#include <nlohmann/json.hpp>
#include <string_view>

#include "base/json.hpp"
#include "base/number_text.hpp"

namespace bbsim::record {
namespace {

// The names of all members, once for both formats. Calls add(name, value) for each.
template <class Add>
void for_each_member(const RunSummary& summary, Add add) {
  add("version", summary.version);
  add("instruction_set", summary.instruction_set);
  add("scenario", summary.scenario);
  add("title", summary.title);
  add("overrides", summary.overrides);
  add("status", summary.status);
  add("reason", summary.reason);
  add("reason_code", summary.reason_code);
  add("warnings", summary.warnings);
  add("end_time", summary.end_time);
  add("rows", summary.rows);
  add("output", summary.output);
  add("states", summary.states);
  add("model_notes", summary.model_notes);
  add("method", summary.method);
  add("rtol", summary.rtol);
  add("atol", summary.atol);
  if (summary.error_bound) add("error_bound", *summary.error_bound);
  if (summary.error_estimate) add("error_estimate", *summary.error_estimate);
}

template <class Add>
void for_each_statistic(const RunSummary& summary, Add add) {
  add("steps", summary.statistics.steps);
  add("rhs_evaluations", summary.statistics.rhs_evaluations);
  add("jacobian_evaluations", summary.statistics.jacobian_evaluations);
  add("nonlinear_iterations", summary.statistics.nonlinear_iterations);
  add("error_test_failures", summary.statistics.error_test_failures);
  add("cpu_seconds", summary.statistics.cpu_seconds);
}

std::string to_text(const std::string& value) {
  return value;
}
std::string to_text(double value) {
  return number_text(value);
}
file::AttributeValue to_value(const std::string& value) {
  return value;
}
file::AttributeValue to_value(double value) {
  return value;
}
file::AttributeValue to_value(std::size_t value) {
  return value;
}
file::AttributeValue to_value(const std::vector<std::string>& values) {
  std::string text;
  for (const std::string& value : values) text += (text.empty() ? "" : "\n") + value;
  return text;
}

// The names in an event, once for both formats.
template <class Add>
void for_each_member(const EventRecord& event, Add add) {
  add("t", event.t);
  add("event", event.name);
  add("action", event.action);
  add("x", event.x);
  add("y", event.y);
  add("vx", event.vx);
  add("vy", event.vy);
  add("spin", event.spin);
  add("phi", event.phi);
  add("theta", event.theta);
  add("phi_rate", event.phi_rate);
  add("theta_rate", event.theta_rate);
}

template <class Add>
void for_each_member(const MotorPeaks& peaks, Add add) {
  add("peak_torque_phi", peaks.torque_phi.value);
  add("peak_torque_phi_at", peaks.torque_phi.at);
  add("peak_torque_theta", peaks.torque_theta.value);
  add("peak_torque_theta_at", peaks.torque_theta.at);
  add("peak_power", peaks.power.value);
  add("peak_power_at", peaks.power.at);
}

}  // namespace

EventRecord event_record(const model::Occurrence& occurrence) {
  const model::BallMotion& ball = occurrence.sample.ball;
  const model::GimbalState& gimbal = occurrence.sample.gimbal;
  return {occurrence.t, occurrence.name, occurrence.stopped ? "stop" : "note",
          ball.x,       ball.y,          ball.x_dot,
          ball.y_dot,   ball.gamma_dot,  gimbal.phi,
          gimbal.theta, gimbal.phi_dot,  gimbal.theta_dot};
}

std::string to_json(const RunSummary& summary) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for_each_member(summary, [&](const char* name, const auto& value) { json[name] = value; });
  if (summary.peaks) {
    nlohmann::ordered_json& motors = json["motors"] = nlohmann::ordered_json::object();
    for_each_member(*summary.peaks,
                    [&](const char* name, const auto& value) { motors[name] = value; });
    motors["carries"] = summary.peaks->with_plate ? "ball and plate" : "ball";
  }
  if (!summary.measures.empty()) {
    nlohmann::ordered_json& measures = json["measures"] = nlohmann::ordered_json::object();
    for (const auto& [name, value] : summary.measures) measures[name] = value;
  }
  if (!summary.gradients.empty()) {
    nlohmann::ordered_json& gradients = json["gradients"] = nlohmann::ordered_json::object();
    for (const auto& [measure, by_key] : summary.gradients) {
      for (const auto& [key, value] : by_key) gradients[measure][key] = value;
    }
  }
  if (summary.unreliable) {
    nlohmann::ordered_json& all = json["unreliable"] = nlohmann::ordered_json::array();
    for (const UnreliableRecord& record : *summary.unreliable) {
      nlohmann::ordered_json& entry = all.emplace_back(nlohmann::ordered_json::object());
      entry["key"] = record.key;
      entry["column"] = record.column;
      entry["time"] = record.time;
    }
  }
  if (!summary.expectations.empty()) {
    nlohmann::ordered_json& all = json["expectations"] = nlohmann::ordered_json::array();
    for (const ExpectationRecord& expectation : summary.expectations) {
      nlohmann::ordered_json& entry = all.emplace_back(nlohmann::ordered_json::object());
      entry["text"] = expectation.text;
      entry["value"] = expectation.value;
      entry["holds"] = expectation.holds;
    }
  }
  nlohmann::ordered_json& events = json["events"] = nlohmann::ordered_json::array();
  for (const EventRecord& event : summary.events) {
    nlohmann::ordered_json& entry = events.emplace_back(nlohmann::ordered_json::object());
    for_each_member(event, [&](const char* name, const auto& value) { entry[name] = value; });
  }
  nlohmann::ordered_json& statistics = json["statistics"] = nlohmann::ordered_json::object();
  for_each_statistic(summary,
                     [&](const char* name, const auto& value) { statistics[name] = value; });
  json["scenario_text"] = summary.scenario_text;
  constexpr int indent = 2;
  return json_text(json, indent) + "\n";
}

file::Attributes to_attributes(const RunSummary& summary, const std::string& scenario_text) {
  file::Attributes attributes;
  const auto add = [&](const std::string_view name, const auto& value) {
    // Equal runs give the same bytes, even with other output files and durations.
    if (name != "output" && name != "cpu_seconds") attributes.emplace_back(name, to_value(value));
  };
  for_each_member(summary, add);
  for_each_statistic(summary, add);
  if (summary.peaks) for_each_member(*summary.peaks, add);
  for (const auto& [name, value] : summary.measures) add("measure " + name, value);
  for (const auto& [measure, by_key] : summary.gradients) {
    for (const auto& [key, value] : by_key) {
      add("gradient d(" + measure + ")/d(" + key + ")", value);
    }
  }
  if (summary.unreliable) {
    std::vector<std::string> unreliable;
    for (const UnreliableRecord& record : *summary.unreliable) {
      unreliable.push_back("key=" + record.key + " column=" + record.column +
                           " time=" + to_text(record.time));
    }
    add("unreliable", unreliable);
  }
  if (!summary.expectations.empty()) {
    std::vector<std::string> expectations;
    for (const ExpectationRecord& expectation : summary.expectations) {
      expectations.push_back(expectation.text +
                             (expectation.holds ? ": holds, " : ": does not hold, ") +
                             to_text(expectation.value));
    }
    add("expectations", expectations);
  }
  std::vector<std::string> events;
  for (const EventRecord& event : summary.events) {
    std::string line;
    for_each_member(event, [&](const char* name, const auto& value) {
      if (!line.empty()) line += ' ';
      line += name;
      line += '=';
      line += to_text(value);
    });
    events.push_back(line);
  }
  add("events", events);
  add("scenario_text", scenario_text);
  return attributes;
}

}  // namespace bbsim::record
