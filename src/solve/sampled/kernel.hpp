// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The stepper's interface to one piece of a rig between two instants under a held command, for
// every instruction set.
//
// Only plain data and pointers to functions: code here could be compiled for one instruction set
// and run on another.
#pragma once

#include <cstddef>

#include "model/ball/contact_force.hpp"
#include "model/servo/three_servos.hpp"

namespace bbsim::solve::sampled {

inline constexpr int nodes = 8;  // of Radau IIA

// A servo's motion (model/servo/held_motion.hpp) at the nodes of a piece: the contributions of its
// initial rate and acceleration to its angle, rate and acceleration. Depends only on the law and
// the length.
struct alignas(64) MotionTable {
  enum Row { angle, rate, acceleration, rows };
  double by_rate[rows][nodes], by_acceleration[rows][nodes];
  // The greatest magnitudes of the angle's contributions.
  double most_by_rate, most_by_acceleration;
  // The initial acceleration of the polynomial through the nodes, minus the true one. A jump that
  // is over before the first node leaves no other trace.
  double missed_by_rate, missed_by_acceleration;
  // What integrating the nodal accelerations misses of the rate and angle at the end: all of a
  // motion that is over between two nodes. `lost`: whether this exceeds rounding.
  bool lost;
  double lost_rate_by_rate, lost_rate_by_acceleration;
  double lost_angle_by_rate, lost_angle_by_acceleration;
};

// One servo at the start of the piece, and the linear map from its angle to that of the plate or of
// the horn that moves it. A motion with drift has a table of its own, for a rate of 1.
struct PieceAxis {
  const MotionTable* table;
  double angle, rate, acceleration;  // factors of the table's rows: those at the start, or 1 and 0
  double ratio, offset;
  double start_rate, start_acceleration;
};

// The motion of the plate over a piece. The servos determine it.
struct alignas(64) PlateMotion {
  struct Plane {
    double sin[nodes], cos[nodes], rate[nodes], acceleration[nodes];
  } plane[2];
  // How far three servos are from the edge of their workspace (ThreeServos::edges).
  double edges[model::ThreeServos::edge_count][nodes];
  PieceAxis axis[model::most_servos];
  // The greatest rate of phi or theta for a unit rate of one horn; 1 without a mechanism.
  double gain;
  // The mechanism between horns and plate. Without one both are null, and what follows is unused.
  const model::Linkages* linkages;
  const model::ThreeServos* three;
  model::GimbalAngle<double> plane_start[2];
  double edges_start[model::ThreeServos::edge_count];
  // Of three servos: the pose, and its derivatives (ThreeServos::pose_slopes).
  struct Legs {
    model::ThreeServos::Pose<double> pose;
    double slopes[3][3];
  } legs_start, legs_end;
};

// Constants of a run.
struct Scene {
  double radius, mass, gravity;
  model::GeneralRolling rolling;
  model::GimbalBody body;
  double rtol, atol;
  bool gamma;                // whether the integral of u is under error control too
  double friction;           // friction coefficient up to which the ball rolls; 0: not monitored
  bool force, sizes, loads;  // whether forces, the sizes of motions, and motors' loads are wanted
};

// All numbers of the last piece. The ball's velocities are x', y' and u = r gamma'; its positions
// are x, y and the integral of u.
struct alignas(64) Piece {
  double velocity_at[3][nodes], position_at[2][nodes], acceleration_at[3][nodes];
  double reference_at[2][nodes];  // x and y at the start and at all nodes but the first, if wanted
  // Shifted Legendre coefficients of the accelerations times the length.
  double series[3][nodes];
  double position[3], velocity[3];          // at the start
  double position_end[3], velocity_end[3];  // at the end
  double guess[3];     // of the accelerations: those at the end of the last piece
  double contraction;  // of the last pieces' iterations
  double length;       // s
  PlateMotion plate;
};
// Vectors are loaded from arrays over the nodes.
static_assert(offsetof(Piece, reference_at) % 64 == 0 && offsetof(Piece, series) % 64 == 0);

struct Attempt {
  bool converged;
  double error;     // estimated local error relative to the tolerance; passes at 1 or below
  int worst_state;  // the state with the largest error estimate
  int iterations;
};

// Quantities that are evaluated for events and bounds. They are smooth: squares instead of roots.
enum Quantity : int {
  x,
  y,
  distance_squared,
  up,      // the upward component of the plate's normal
  normal,  // force over mass, m/s^2
  grip,    // (friction N)^2 - F_t^2, both per mass
  vx,
  vy,
  rate_squared,   // of the plate's angular velocity, rad^2/s^2
  error_squared,  // of the distance from the reference, m^2
  torque_phi,     // of the motors, N m
  torque_theta,   // N m
  power,          // W
  quantity_count
};

// The range of a quantity. `trend`: 1 or -1 if it rises or falls all the way, 0 if it may turn.
struct Range {
  double least, most;
  int trend = 0;
};

// Quantities are evaluated at the start and at all nodes but the first, which is close to the
// start. Within the piece a polynomial may exceed the range of these values by this fraction of it:
// (L - 1) / 2, where L = 3.5806 is the points' Lebesgue constant.
inline constexpr double overshoot = 1.2904;

// Each quantity at the start and at all nodes but the first; only if sizes or loads are wanted.
struct alignas(64) QuantityValues {
  double at[quantity_count][nodes];
};

// A polynomial of degree 7 may exceed its range at 32 Chebyshev points by this fraction of it:
// (1 / cos(7 pi / 64) - 1) / 2 (Ehlich and Zeller, Math. Z. 86:41, 1964).
inline constexpr int close_points = 32;
inline constexpr double close_overshoot = 0.0313;

// A servo's impulse response (model/servo/held_motion.hpp) at the nodes of a piece.
struct alignas(64) NodeAnswers {
  double integral[nodes], value[nodes], slope[nodes];
};

struct Kernels {
  // For the paper's rig, for any rig whose servos turn the plate directly, and for rigs with
  // linkages and with three servos.
  struct Of {
    // Solves for the ball over the piece, from its start, length and axes.
    void (*attempt)(Piece& piece, const Scene& scene, Attempt& result);
    // Computes the ranges over the start and nodes. Leaves ranges that are not wanted unchanged.
    void (*evaluate_quantities)(const Piece& piece, const Scene& scene, Range* ranges,
                                QuantityValues& values);
  } papers, general, linked, three;
  // Computes responses by power series, which the length must suit (model::suits_series()).
  void (*answers)(double damping, double stiffness, double length, NodeAnswers& answers);
  // The range over the Chebyshev points of a quantity with these values, and its trend.
  Range (*narrow)(const double (&values)[nodes]);
  // Evaluates the ball at `count` times (s) after the start of the piece, on its polynomial: x, y,
  // x', y', u and the integral of u.
  void (*evaluate)(const Piece& piece, const double* times, std::size_t count, double (*ball)[6]);
};

// The kernels of an instruction set (kernels.cpp).
template <class Isa>
[[nodiscard]] const Kernels& kernels();

}  // namespace bbsim::solve::sampled
