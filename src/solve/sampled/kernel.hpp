// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// One piece of a rig between two instants, its command held: what the stepper sees of it, whatever
// the instruction set.
//
// Plain data and pointers to functions only; nothing here may become code that two instruction
// sets share.
#pragma once

#include <cstddef>

#include "model/ball/contact_force.hpp"

namespace bbsim::solve::sampled {

inline constexpr int nodes = 8;  // of Radau IIA

// A servo's motion (model/servo/held_motion.hpp) at the nodes of a piece: what its rate and its
// acceleration at the start add to each of the three. It depends on the law and the length alone.
struct alignas(64) MotionTable {
  enum Row { angle, rate, acceleration, rows };
  double by_rate[rows][nodes], by_acceleration[rows][nodes];
  // The greatest sizes of the angle's.
  double most_by_rate, most_by_acceleration;
  // What the polynomial through the accelerations at the nodes says of the start, less what is
  // there: a jump that is over before the first node leaves no other trace.
  double missed_by_rate, missed_by_acceleration;
  // What the accelerations at the nodes, integrated, leave out of the rate and of the angle at the
  // end: of a motion that is over between two nodes, all. `lost` if it is more than rounding.
  bool lost;
  double lost_rate_by_rate, lost_rate_by_acceleration;
  double lost_angle_by_rate, lost_angle_by_acceleration;
};

// One axis: its servo at the piece's start, and how the plane's angle follows it.
struct Axis {
  const MotionTable* table;
  double angle, rate, acceleration;
  double ratio, offset;
};

// What stays the same over a run.
struct Scene {
  double radius, mass, gravity;
  model::GeneralRolling rolling;
  model::Turned turned;
  double rtol, atol;
  bool gamma;         // the integral of u is under the tolerance too
  double friction;    // coefficient up to which the ball rolls; 0: nobody asks
  bool force, loads;  // whether somebody asks for forces, and for the motors' torques
};

// Everything about the last piece. The ball's velocities are x', y' and u = r gamma'; its positions
// x, y and the integral of u.
struct alignas(64) Piece {
  double velocity_at[3][nodes], position_at[2][nodes], acceleration_at[3][nodes];
  struct Plane {
    double sin[nodes], cos[nodes], rate[nodes], acceleration[nodes];
  } plane[2];
  // Shifted Legendre coefficients of the accelerations times the length.
  double series[3][nodes];
  double position[3], velocity[3];          // at the start
  double position_end[3], velocity_end[3];  // and at the end
  double guess[3];     // of the accelerations: those that the last piece ended with
  double contraction;  // of the last pieces' iterations
  double length;       // s
  Axis axis[2];
};

struct Attempt {
  bool converged;
  double error;     // estimated local error in the tolerance's weights: at most 1 is good
  int worst_state;  // the state with the largest estimate
  int iterations;
};

// Things that are looked at, smooth ones alone: a square in place of a root.
enum Look : int {
  x,
  y,
  distance_squared,
  up,            // of the plane's normal, the part against gravity
  normal,        // force over mass, m/s^2
  grip,          // (friction N)^2 - F_t^2, each over the mass
  torque_phi,    // of the motors, N m
  torque_theta,  // N m
  power,         // W
  looks
};

struct Range {
  double least, most;
};

// What is looked at are the start and the nodes but the first, which is next to it. How far beyond
// its values there a polynomial may go within the piece, as a part of their range: (L - 1) / 2 of
// the points' Lebesgue constant L = 3.5806.
inline constexpr double overshoot = 1.2904;

// The motors' loads at the start and at the nodes but the first.
struct alignas(64) Loads {
  double at[3][nodes];  // of torque_phi and those after it
};

// How far a polynomial of degree 7 may go beyond its values at 32 Chebyshev points, as a part of
// their range: (1 / cos(7 pi / 64) - 1) / 2 (Ehlich and Zeller, Math. Z. 86:41, 1964).
inline constexpr int close_points = 32;
inline constexpr double close_overshoot = 0.0313;

// What a servo answers to an impulse (model/servo/held_motion.hpp), at the nodes of a piece.
struct alignas(64) NodeAnswers {
  double integral[nodes], value[nodes], slope[nodes];
};

struct Kernels {
  // For the paper's rig, and for any.
  struct Of {
    // Solves for the ball over the piece, from its start, length and axes.
    void (*attempt)(Piece& piece, const Scene& scene, Attempt& result);
    // The ranges over start and nodes; those that nobody asks for are left as they are.
    void (*look)(const Piece& piece, const Scene& scene, Range* ranges, Loads& loads);
  } papers, general;
  // By power series: for pieces whose length suits it (model::suits_series()).
  void (*answers)(double damping, double stiffness, double length, NodeAnswers& answers);
  // The ranges of the three loads over the Chebyshev points.
  void (*look_closely)(const Loads& loads, Range* ranges);
  // Positions and velocities of the ball at `count` times after the piece's start, by its
  // polynomial: x, y, x', y', u and the integral of u at each.
  void (*evaluate)(const Piece& piece, const double* times, std::size_t count, double (*ball)[6]);
};

}  // namespace bbsim::solve::sampled
