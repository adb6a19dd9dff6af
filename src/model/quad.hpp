// Lets equation (27) be evaluated in quad precision: what the templates of this room find by
// argument-dependent lookup for a Quad. Include it wherever one of them is given a Quad.
#pragma once

#include "base/quad.hpp"
#include "model/rolling.hpp"

namespace bbsim {

[[nodiscard]] inline model::SinCos<Quad> sin_cos(const Quad& angle) {
  model::SinCos<Quad> direction;
  sin_cos(angle, &direction.sin, &direction.cos);
  return direction;
}

}  // namespace bbsim
