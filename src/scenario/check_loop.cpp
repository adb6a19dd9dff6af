// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reports what is missing beside `controller.drives`: a servo, a motor, a motion (sections.hpp).
#include "base/number_text.hpp"
#include "scenario/relations.hpp"
#include "scenario/sections.hpp"
#include "yaml/quantity.hpp"

namespace bbsim::scenario {
namespace {

// The value at section.key, if present.
std::optional<yaml::Value> find_in(yaml::Keys& scenario, std::string_view section,
                                   std::string_view key) {
  const std::optional<yaml::Value> mapping = scenario.find(section);
  return mapping ? yaml::Keys(*mapping).find(key) : std::nullopt;
}

// Reports the message at the key of `value`.
void report(const yaml::Value& value, const std::string& message) {
  value.context->problems.add(value.position, value.path + ": " + message);
}

// Reports the message at `gimbal`, or at the top level without `gimbal`.
void report_missing(yaml::Keys& scenario, const std::string& message) {
  const std::optional<yaml::Value> gimbal = scenario.find("gimbal");
  const yaml::Value& place = gimbal ? *gimbal : scenario.mapping();
  place.context->problems.add(place.position, message);
}

// Refuses a number as the gain of a law that drives angles, because it pushes the ball away along
// y.
void check_signs(yaml::Keys& scenario) {
  for (const char* const law : {"pd", "pid"}) {
    const auto gains = find_in(scenario, "controller", law);
    for (const char* const key : {"kv", "kp", "ki"}) {
      const auto gain = gains ? yaml::Keys(*gains).find(key) : std::nullopt;
      if (!gain || gain->node->kind != yaml::Node::Kind::scalar) continue;
      const double k =
          yaml::read_quantity(gain->node->text, gain->node->quoted, yaml::Dimension::number)
              .value.value_or(0);
      if (k == 0) continue;
      const std::string theirs = number_text(k), reversed = number_text(-k);
      report(*gain, "found " + theirs + ", which means [[" + theirs + ", 0], [0, " + theirs +
                        "]], but positive theta drives the ball towards -y; allowed: [[" + theirs +
                        ", 0], [0, " + reversed +
                        "]], or another matrix with rows phi, theta and columns x, y");
    }
  }
}

// Checks nothing for an invalid value of `drives`, which the reader has reported.
void check_servo(yaml::Keys& scenario) {
  const auto drives = find_in(scenario, "controller", "drives");
  const std::string driven = drives ? drives->node->text : "acceleration";
  const auto servo = find_in(scenario, "gimbal", "servo");
  const auto motor = find_in(scenario, "gimbal", "motor");
  const auto loop = motor ? yaml::Keys(*motor).find("position_loop") : std::nullopt;
  if ((driven == "angle" && !servo && !motor) || (driven == "legs" && !servo)) {
    report_missing(scenario, "gimbal.servo: missing, but controller.drives is " + driven +
                                 "; allowed: a mapping with natural_frequency, damping");
  }
  if (driven == "angle" && motor && !servo && !loop) {
    report(*motor,
           "found without position_loop, but controller.drives is angle; allowed: a position_loop "
           "that follows the angle, or drives: torque or voltage");
  }
  if (driven == "angle" && motor && servo) {
    report(*servo,
           "found beside gimbal.motor, but a servo moves at any torque; allowed: one of the two");
  }
  if (driven == "angle") check_signs(scenario);
  check_relations(scenario, driven == "acceleration"
                                ? "controller and controller.drives=acceleration|"
                                : "controller.drives=" + driven);
  if (driven == "voltage" && !(motor && yaml::Keys(*motor).find("dc"))) {
    report_missing(scenario,
                   "gimbal.motor.dc: missing, but controller.drives is voltage; allowed: a mapping "
                   "with resistance, torque_constant");
  }
}

}  // namespace

void check_loop(yaml::Keys& scenario) {
  const auto motion = find_in(scenario, "gimbal", "motion");
  const auto torque = find_in(scenario, "gimbal", "torque");
  const auto controller = scenario.find("controller");
  if (motion && controller) {
    report(*controller,
           "found beside gimbal.motion; allowed: exactly one of the two, since either the scenario "
           "prescribes the motion or the controller drives it");
  } else if (torque && (motion || controller)) {
    report(*torque, std::string("found beside ") + (motion ? "gimbal.motion" : "controller") +
                        "; allowed: exactly one of gimbal.motion, gimbal.torque and controller");
  } else if (motion) {
    check_relations(scenario, "gimbal.motion");
  } else if (torque) {
    check_relations(scenario, "gimbal.torque");
  } else if (controller) {
    check_servo(scenario);
  } else {
    report_missing(scenario,
                   "gimbal.motion: missing, and so is controller; allowed: exactly one of the two");
  }
}

}  // namespace bbsim::scenario
