// The rig in Simbody, behind an interface that C++17 and C++20 both take: Simbody 3.7 is not C++20.
#pragma once

#include <array>
#include <functional>
#include <vector>

namespace crosscheck {

struct Rig {
  double radius = 0, mass = 1, gravity = 0;      // m, kg, m/s^2
  std::array<double, 2> position{}, velocity{};  // of the contact point in the plane, m, m/s
  double spin = 0;                               // rad/s
  // Value (order 0), rate (1) or acceleration (2) of phi (axis 0) or theta (1) at a time.
  std::function<double(double time, int axis, int order)> angle;
};

// The contact point (x, y) at each of the times, which start at 0.
std::vector<std::array<double, 2>> simulate(const Rig& rig, const std::vector<double>& times);

}  // namespace crosscheck
