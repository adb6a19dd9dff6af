#include "scenario/columns.hpp"
#include "scenario/sections.hpp"

namespace bbsim::scenario {
namespace {

// The value at section.key, if it is there.
std::optional<yaml::Value> find_in(yaml::Keys& scenario, std::string_view section,
                                   std::string_view key) {
  const std::optional<yaml::Value> mapping = scenario.find(section);
  return mapping ? yaml::Keys(*mapping).find(key) : std::nullopt;
}

// Reports at the key of `value`.
void report(const yaml::Value& value, const std::string& message) {
  value.context->problems.add(value.position, value.path + ": " + message);
}

// Reports it at gimbal, or at the top where there is no gimbal.
void report_missing(yaml::Keys& scenario, const std::string& message) {
  const std::optional<yaml::Value> gimbal = scenario.find("gimbal");
  const yaml::Value& place = gimbal ? *gimbal : scenario.mapping();
  place.context->problems.add(place.position, message);
}

void check_open_loop(yaml::Keys& scenario) {
  if (const auto start = find_in(scenario, "gimbal", "start")) {
    report(*start,
           "found beside gimbal.motion, which says where the gimbal starts; allowed: only "
           "with a controller");
  }
  if (const auto servo = find_in(scenario, "gimbal", "servo")) {
    report(*servo,
           "found beside gimbal.motion, which no servo follows; allowed: only with a "
           "controller that drives angle");
  }
}

// Where `drives` is neither, it has been reported already, and says nothing of the servo.
void check_servo(yaml::Keys& scenario) {
  const auto drives = find_in(scenario, "controller", "drives");
  const std::string driven = drives ? drives->node->text : "acceleration";
  const auto servo = find_in(scenario, "gimbal", "servo");
  if (driven == "angle" && !servo) {
    report_missing(scenario,
                   "gimbal.servo: missing, but controller.drives is angle; allowed: a mapping with "
                   "natural_frequency, damping");
  }
  if (driven == "acceleration" && servo) {
    report(*servo,
           "found, but controller.drives is acceleration, which no servo follows; allowed: "
           "only with drives: angle");
  }
}

}  // namespace

void check_loop(yaml::Keys& scenario) {
  const auto motion = find_in(scenario, "gimbal", "motion");
  const auto controller = scenario.find("controller");
  if (motion && controller) {
    report(*controller,
           "found beside gimbal.motion; allowed: exactly one of the two, since either "
           "the motion is prescribed or the controller makes it");
  } else if (motion) {
    check_open_loop(scenario);
  } else if (controller) {
    check_servo(scenario);
  } else {
    report_missing(scenario,
                   "gimbal.motion: missing, and so is controller; allowed: exactly one of the two");
  }
}

}  // namespace bbsim::scenario
