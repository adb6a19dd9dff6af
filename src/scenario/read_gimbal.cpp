#include "scenario/profile.hpp"
#include "scenario/rules.hpp"
#include "scenario/sections.hpp"

namespace bbsim::input {
namespace {

void read_motion(Keys& keys, GimbalMotion& motion) {
  keys.optional("phi", ProfileRule{}, motion.phi);
  keys.optional("theta", ProfileRule{}, motion.theta);
}

void read_start(Keys& keys, GimbalStart& start) {
  keys.optional("phi", Number{Dimension::angle}, start.phi);
  keys.optional("theta", Number{Dimension::angle}, start.theta);
  keys.optional("phi_rate", Number{Dimension::angular_rate}, start.phi_rate);
  keys.optional("theta_rate", Number{Dimension::angular_rate}, start.theta_rate);
}

void read_servo(Keys& keys, Servo& servo) {
  const Number time{Dimension::time, {.above = 0}};
  keys.optional("time_constant", time, servo.time_constant);
  const Number frequency{Dimension::angular_rate, {.above = 0}};
  const Number damping{Dimension::number, {.at_least = 0}};
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
  keys.optional("angle_limit", AngleLimit{{.above = 0}}, servo.angle_limit);
  keys.optional("rate_limit", Number{Dimension::angular_rate, {.above = 0}}, servo.rate_limit);
  keys.optional("acceleration_limit", Number{Dimension::number, {.above = 0}, "200"},
                servo.acceleration_limit);
  keys.optional("dead_band", AngleLimit{{.at_least = 0}}, servo.dead_band);
  // Below that, rounding would decide when the servo touches the plane.
  constexpr double least_backlash = 1e-6;
  if (keys.optional("backlash", AngleLimit{{.at_least = 0}}, servo.backlash) &&
      servo.backlash > 0 && servo.backlash < least_backlash) {
    keys.find("backlash")->refuse("", "0, or an angle of at least 1e-6 rad");
  }
}

void read_mounting(Keys& keys, Mounting& mounting) {
  keys.optional("height", Number{Dimension::length}, mounting.height);
  keys.optional("phi_offset", Number{Dimension::angle}, mounting.phi_offset);
  keys.optional("theta_offset", Number{Dimension::angle}, mounting.theta_offset);
  // At 90 degrees the axes would be one.
  keys.optional("skew", Number{Dimension::angle, {.at_least = -1.4, .at_most = 1.4}},
                mounting.skew);
  keys.optional("yaw", Number{Dimension::angle}, mounting.yaw);
  keys.optional("base_tilt", Number{Dimension::angle}, mounting.base_tilt);
}

}  // namespace

void read_gimbal(Keys& keys, Gimbal& gimbal) {
  keys.optional("motion", MappingOf(read_motion), gimbal.motion);
  keys.optional("start", MappingOf(read_start), gimbal.start);
  keys.optional("servo", MappingOf(read_servo), gimbal.servo);
  keys.section("mounting", read_mounting, gimbal.mounting);
}

}  // namespace bbsim::input
