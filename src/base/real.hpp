// What templates on a number type ask of it, for doubles; other types overload it.
#pragma once

#include <cmath>

namespace bbsim {

// Sine and cosine together. Overloaded for number types that have a faster way.
template <class Real>
struct SinCos {
  Real sin, cos;
};

template <class Real>
[[nodiscard]] SinCos<Real> sin_cos(const Real& angle) {
  using std::cos;
  using std::sin;
  return {sin(angle), cos(angle)};
}

// The root of `square`, with the sign of `along`: the length of a vector as a coordinate that goes
// on smoothly through zero, where the vector turns round.
[[nodiscard]] inline double root_along(double square, double along) {
  return std::copysign(std::sqrt(square), along);
}

// The time as a plain double, to choose an interval by. Overloaded for other number types.
[[nodiscard]] inline double plain(double t) {
  return t;
}

}  // namespace bbsim
