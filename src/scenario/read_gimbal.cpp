#include "scenario/profile.hpp"
#include "scenario/sections.hpp"
#include "yaml/rules.hpp"

namespace bbsim::scenario {
namespace {

void read_motion(yaml::Keys& keys, GimbalMotion& motion) {
  keys.optional("phi", ProfileRule{}, motion.phi);
  keys.optional("theta", ProfileRule{}, motion.theta);
}

void read_start(yaml::Keys& keys, GimbalStart& start) {
  keys.optional("phi", yaml::Number{yaml::Dimension::angle}, start.phi);
  keys.optional("theta", yaml::Number{yaml::Dimension::angle}, start.theta);
  keys.optional("phi_rate", yaml::Number{yaml::Dimension::angular_rate}, start.phi_rate);
  keys.optional("theta_rate", yaml::Number{yaml::Dimension::angular_rate}, start.theta_rate);
}

void read_servo(yaml::Keys& keys, Servo& servo) {
  const yaml::Number time{yaml::Dimension::time, {.above = 0}};
  keys.optional("time_constant", time, servo.time_constant);
  const yaml::Number frequency{yaml::Dimension::angular_rate, {.above = 0}};
  const yaml::Number damping{yaml::Dimension::number, {.at_least = 0}};
  if (keys.find("time_constant")) {
    for (const char* other : {"natural_frequency", "damping"}) {
      if (const auto given = keys.find(other)) {
        given->report(
            "given together with time_constant, of a servo of first order; allowed: "
            "natural_frequency and damping, or time_constant");
      }
    }
  } else {
    keys.required("natural_frequency", frequency, servo.natural_frequency);
    keys.required("damping", damping, servo.damping);
  }
  keys.optional("angle_limit", yaml::AngleLimit{{.above = 0}}, servo.angle_limit);
  keys.optional("rate_limit", yaml::Number{yaml::Dimension::angular_rate, {.above = 0}},
                servo.rate_limit);
  keys.optional("acceleration_limit", yaml::Number{yaml::Dimension::number, {.above = 0}, "200"},
                servo.acceleration_limit);
  keys.optional("dead_band", yaml::AngleLimit{{.at_least = 0}}, servo.dead_band);
  // Below that, rounding would decide when the servo touches the plane.
  constexpr double least_backlash = 1e-6;
  if (keys.optional("backlash", yaml::AngleLimit{{.at_least = 0}}, servo.backlash) &&
      servo.backlash > 0 && servo.backlash < least_backlash) {
    keys.find("backlash")->refuse("", "0, or an angle of at least 1e-6 rad");
  }
}

void read_mounting(yaml::Keys& keys, Mounting& mounting) {
  keys.optional("height", yaml::Number{yaml::Dimension::length}, mounting.height);
  keys.optional("phi_offset", yaml::Number{yaml::Dimension::angle}, mounting.phi_offset);
  keys.optional("theta_offset", yaml::Number{yaml::Dimension::angle}, mounting.theta_offset);
  // At 90 degrees the axes would be one.
  keys.optional("skew", yaml::Number{yaml::Dimension::angle, {.at_least = -1.4, .at_most = 1.4}},
                mounting.skew);
  keys.optional("yaw", yaml::Number{yaml::Dimension::angle}, mounting.yaw);
  keys.optional("base_tilt", yaml::Number{yaml::Dimension::angle}, mounting.base_tilt);
}

}  // namespace

void read_gimbal(yaml::Keys& keys, Gimbal& gimbal) {
  keys.optional("motion", yaml::MappingOf(read_motion), gimbal.motion);
  keys.optional("start", yaml::MappingOf(read_start), gimbal.start);
  keys.optional("servo", yaml::MappingOf(read_servo), gimbal.servo);
  keys.section("mounting", read_mounting, gimbal.mounting);
}

}  // namespace bbsim::scenario
