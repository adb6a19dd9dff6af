#include "scenario/profile.hpp"
#include "scenario/sections.hpp"
#include "yaml/rules.hpp"

namespace bbsim::scenario {
namespace {

void read_motion(yaml::Keys& keys, GimbalMotion& motion) {
  keys.optional("phi", ProfileRule{}, motion.phi);
  keys.optional("theta", ProfileRule{}, motion.theta);
}

void read_torque(yaml::Keys& keys, GimbalMotion& torque) {
  keys.optional("phi", ProfileRule{true}, torque.phi);
  keys.optional("theta", ProfileRule{true}, torque.theta);
}

void read_dc(yaml::Keys& keys, DcMotor& dc) {
  const yaml::Number positive{yaml::Dimension::number, {.above = 0}};
  keys.required("resistance", positive, dc.resistance);
  keys.required("torque_constant", positive, dc.torque_constant);
  keys.optional("gear", positive, dc.gear);
  keys.optional("voltage_limit", positive, dc.voltage_limit);
}

void read_position_loop(yaml::Keys& keys, PositionLoop& loop) {
  const yaml::Number gain{yaml::Dimension::number, {.at_least = 0}};
  keys.required("kp", yaml::Number{yaml::Dimension::number, {.above = 0}}, loop.kp);
  keys.optional("kd", gain, loop.kd);
  keys.optional("ki", gain, loop.ki);
}

void read_motor(yaml::Keys& keys, Motor& motor) {
  const yaml::Number at_least_none{yaml::Dimension::number, {.at_least = 0}, "1e-3"};
  keys.optional("rotor_inertia", at_least_none, motor.rotor_inertia);
  keys.optional("viscous", at_least_none, motor.viscous);
  keys.optional("friction", at_least_none, motor.friction);
  keys.optional("torque_limit", yaml::Number{yaml::Dimension::number, {.above = 0}, "0.2"},
                motor.torque_limit);
  keys.optional("dc", yaml::MappingOf(read_dc), motor.dc);
  keys.optional("position_loop", yaml::MappingOf(read_position_loop), motor.position_loop);
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
  keys.optional("torque", yaml::MappingOf(read_torque), gimbal.torque);
  keys.optional("start", yaml::MappingOf(read_start), gimbal.start);
  keys.optional("servo", yaml::MappingOf(read_servo), gimbal.servo);
  keys.optional("ring_inertia", yaml::Number{yaml::Dimension::number, {.at_least = 0}, "1e-3"},
                gimbal.ring_inertia);
  keys.optional("motor", yaml::MappingOf(read_motor), gimbal.motor);
  keys.section("mounting", read_mounting, gimbal.mounting);
}

}  // namespace bbsim::scenario
