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
  keys.required("natural_frequency", Number{Dimension::angular_rate, {.above = 0}},
                servo.natural_frequency);
  keys.required("damping", Number{Dimension::number, {.at_least = 0}}, servo.damping);
}

}  // namespace

void read_gimbal(Keys& keys, Gimbal& gimbal) {
  keys.optional("motion", MappingOf(read_motion), gimbal.motion);
  keys.optional("start", MappingOf(read_start), gimbal.start);
  keys.optional("servo", MappingOf(read_servo), gimbal.servo);
}

}  // namespace bbsim::input
