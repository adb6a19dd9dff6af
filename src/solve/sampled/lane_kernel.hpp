// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Rigs between two instants, another one in each lane: what their driver sees of them, whatever the
// instruction set.
//
// Plain data and pointers to functions; kernels may call no function that is not of their own
// instruction set, and so none on doubles of what is included here.
#pragma once

#include "model/control/sampled_law.hpp"
#include "model/signals/signal_pair.hpp"
#include "solve/sampled/kernel.hpp"

namespace bbsim::solve::sampled {

// Rigs that go together; the same on every processor, so that each case of a sweep has the same
// companions everywhere.
inline constexpr int group = 8;

// One axis of each: its servo at the start, how it moves (MotionTable), and the plane at the nodes.
struct alignas(64) LaneAxis {
  double angle[group], rate[group], acceleration[group];
  double angle_end[group], rate_end[group];
  double ratio[group], offset[group];
  double most_by_rate[group], most_by_acceleration[group];
  double missed_by_rate[group], missed_by_acceleration[group];
  double lost_rate_by_rate[group], lost_rate_by_acceleration[group];
  double lost_angle_by_rate[group], lost_angle_by_acceleration[group];
  double by_rate[MotionTable::rows][nodes][group], by_acceleration[MotionTable::rows][nodes][group];
  double plane_sin[nodes][group], plane_cos[nodes][group];
  double plane_rate[nodes][group], plane_acceleration[nodes][group];
  bool lost;                  // something is, in any lane; otherwise those four are zero
  const MotionTable* shared;  // where all move by one table; else null, and by_rate and so on tell
};

// The last piece of each rig, as Piece has it of one. A lane without a piece has no length, and
// what is said of it means nothing.
struct alignas(64) LanePieces {
  double length[group];                           // s
  double position[2][group], velocity[3][group];  // at the start
  double guess[3][group];  // of the accelerations: those that the last piece ended with
  LaneAxis axis[2];
  double velocity_at[3][nodes][group], position_at[2][nodes][group];
  double acceleration_at[3][nodes][group];
  double series[3][nodes][group];
  double position_end[2][group], velocity_end[3][group];
  double contraction[group];  // of its iterations
  // Bounds of the estimates in the tolerance's weights, at most 1 if good; closer_error() tells the
  // estimate. `hopeless` where substitution came to nothing.
  double error[group];
  int iterations;  // of the last attempt, in all packs
};

inline constexpr double hopeless = 1e300;

// What the servos of an axis do in their present modes (model::held_motion): their acceleration is
// push + by_command u - stiffness q - damping q'.
struct alignas(64) LaneServo {
  double push[group], by_command[group], stiffness[group], damping[group];
  double command[group];  // u
  // What switches none as long as they stay within, the root of the stiffness, and its inverse
  // (model::ServoAxis::Clearance).
  double angle_most[group], rate_most[group], acceleration_most[group];
  double root[group], inverse_root[group];
};
struct alignas(64) LaneServos {
  LaneServo of[2];
  double clear[group];  // 1 where no servo switches as long as the commands are held, or 0: ask
};

struct alignas(64) LaneScene {
  double radius[group], gravity[group], friction[group];
  // Between which numbers each Look up to the grip has to stay, so that no event occurs.
  double least[Look::grip + 1][group], most[Look::grip + 1][group];
  double rtol, atol;
  // What is looked at: the contact's force, the plane's tilt and rate, the distance from the
  // reference.
  bool force, gimbal, reference;
};

// What is greatest over a run: smooth numbers, squares in place of roots.
enum class Size : int {
  versine,           // 1 - cos(tilt)
  rate_squared,      // of the plane's angular velocity, (rad/s)^2
  distance_squared,  // m^2
  error_squared      // of the distance from the reference, m^2
};
inline constexpr int sizes = 4;

// What a look finds, at the start and at the nodes but the first: whether a range of those of Look
// may be left, and sizes, each of them and the largest.
struct alignas(64) LaneLooks {
  double size[sizes][nodes][group], least_size[sizes][group], most_size[sizes][group];
  double quiet[group];  // 1 where nothing happens, as far as that tells; else 0
};
// A reference, x and y, at the start and at the nodes but the first.
struct alignas(64) LaneReference {
  double one[2][nodes], at[2][nodes][group];
  bool shared;  // it is `one`; or else each has its own
};

// The controllers at a sample. One that sees nothing is left as it is.
struct alignas(64) Lanes {
  double of[group];
};
struct LaneControl {
  model::SampledLaw<Lanes> law;
  model::SampledMemory<Lanes> memory;
  Lanes sees, is_first;     // 1 or 0
  Lanes elapsed;            // s
  Lanes seen[2], servo[4];  // m; rad and rad/s
  Lanes reference[2][3];    // value, rate and acceleration
  Lanes command[2];         // the last one
};

struct LaneKernels {
  // How the servos of an axis, no two alike, move over pieces of these lengths, s: what MotionTable
  // has of each. By power series: for pieces whose length suits them all (model::suits_series()).
  void (*tables)(LaneAxis& axis, const LaneServo& servo, const double* length);
  // Where pieces begin: the servos' accelerations, and whether they clear their limits.
  void (*start)(LanePieces& pieces, LaneServos& servos);
  // Solves for the balls over the pieces, from their starts, lengths and axes.
  void (*attempt)(LanePieces& pieces, const LaneScene& scene);
  double (*closer_error)(const LanePieces& pieces, const LaneScene& scene, int lane);
  void (*look)(const LanePieces& pieces, const LaneScene& scene, const LaneReference& reference,
               LaneLooks& looks);
  // The range of a lane's size over Chebyshev points (close_overshoot).
  Range (*look_closely)(const LaneLooks& looks, Size size, int lane);
  // The values of a reference, x and y, at the start and at the nodes but the first of a piece.
  void (*reference)(const model::SignalView& of, double from, double length, double (*at)[nodes]);
  // Takes a sample.
  void (*control)(LaneControl& control);
  // x, y, x', y' and u of each at a time of its own after the piece's start.
  void (*evaluate)(const LanePieces& pieces, const double* times, double (*ball)[group]);
};

// Those of the instruction set that was chosen. Throws InputError if the environment variable
// BBSIM_SIMD names none of this processor.
[[nodiscard]] const LaneKernels& choose_lane_kernels();

}  // namespace bbsim::solve::sampled
