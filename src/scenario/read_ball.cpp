#include "scenario/rules.hpp"
#include "scenario/sections.hpp"

namespace bbsim::input {

void read_ball(Keys& keys, Ball& ball) {
  keys.required("radius", Number{Dimension::length, {.above = 0}}, ball.radius);
  keys.optional("mass", Number{Dimension::mass, {.above = 0}}, ball.mass);
  keys.optional("position", PairOf{Dimension::length}, ball.position);
  keys.optional("velocity", PairOf{Dimension::velocity}, ball.velocity);
  keys.optional("spin", Number{Dimension::angular_rate}, ball.spin);
  // All mass at the centre has 0, all of it at the surface 2/3.
  const Number factor{Dimension::number, {.at_least = 0, .at_most = 0.67}, "0.4"};
  keys.optional("inertia_factor", factor, ball.inertia_factor);
}

void read_plate(Keys& keys, Plate& plate) {
  keys.optional("size", SidesOf{}, plate.size);
  const Number diameter{Dimension::length, {.above = 0}};
  if (keys.optional("diameter", diameter, plate.diameter) && plate.diameter && plate.size) {
    keys.find("diameter")->report("given together with size; allowed: one of them");
  }
  keys.optional("inertia", MomentsOf{}, plate.inertia);
}

}  // namespace bbsim::input
