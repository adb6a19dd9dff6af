#include "scenario/rules.hpp"
#include "scenario/sections.hpp"

namespace bbsim::input {

void read_ball(Keys& keys, Ball& ball) {
  keys.required("radius", Number{Dimension::length, {.above = 0}}, ball.radius);
  keys.optional("mass", Number{Dimension::mass, {.above = 0}}, ball.mass);
  keys.optional("position", PairOf{Dimension::length}, ball.position);
  keys.optional("velocity", PairOf{Dimension::velocity}, ball.velocity);
  keys.optional("spin", Number{Dimension::angular_rate}, ball.spin);
}

}  // namespace bbsim::input
