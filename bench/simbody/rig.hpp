// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The rig in Simbody, behind an interface for C++17 and C++20, because Simbody 3.7 is not C++20.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

namespace crosscheck {

// A gimbal driven by torques, and its inertias.
struct Driven {
  std::array<double, 3> plate_inertia{};                // about the gimbal's center, kg m^2
  double plate_mass = 0, centre_of_mass = 0;            // kg; m along the normal
  double ring_inertia = 0, rotor_inertia = 0;           // kg m^2
  double viscous = 0;                                   // N m s
  std::array<double, 2> angles{}, rates{};              // at the start, rad, rad/s
  std::function<double(double time, int axis)> torque;  // of the motors of phi and theta, N m
};

struct Rig {
  double radius = 0, mass = 1, gravity = 0;      // m, kg, m/s^2
  std::array<double, 2> position{}, velocity{};  // of the contact point in the plane, m, m/s
  double spin = 0;                               // rad/s
  // Value (order 0), rate (1) or acceleration (2) of phi (axis 0) or theta (1) at a time.
  std::function<double(double time, int axis, int order)> angle{};
  std::optional<Driven> driven{};  // instead of `angle`
};

// Contact point and gimbal angles (x, y, phi, theta) at each time. The times start at 0.
std::vector<std::array<double, 4>> simulate(const Rig& rig, const std::vector<double>& times);

}  // namespace crosscheck
