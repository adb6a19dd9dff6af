// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The driver's interface to sampled rigs between two instants, with one rig in each lane, for every
// instruction set.
//
// Only plain data and pointers to functions. Kernels must not call functions outside their own
// instruction set, so they call no function on doubles from the headers included here.
#pragma once

#include "model/control/sampled_law.hpp"
#include "model/signals/signal_pair.hpp"
#include "solve/sampled/kernel.hpp"

namespace bbsim::solve::sampled {

// The number of rigs that step together. It is the same on every processor, so that each case of a
// sweep has the same companions everywhere.
inline constexpr int group = 8;

// One servo of all rigs at the start, and its motion (MotionTable).
struct alignas(64) LaneAxis {
  double angle[group], rate[group], acceleration[group];
  double angle_end[group], rate_end[group];
  double ratio[group], offset[group];
  double most_by_rate[group], most_by_acceleration[group];
  double missed_by_rate[group], missed_by_acceleration[group];
  double lost_rate_by_rate[group], lost_rate_by_acceleration[group];
  double lost_angle_by_rate[group], lost_angle_by_acceleration[group];
  double by_rate[MotionTable::rows][nodes][group], by_acceleration[MotionTable::rows][nodes][group];
  bool lost;  // whether any lane has a loss; otherwise the lost_* are zero
  // The table that all lanes use. If null, by_rate and by_acceleration have one for each lane.
  const MotionTable* shared;
};

// An angle of all plates at the nodes and at the start.
struct alignas(64) LanePlane {
  double sin[nodes][group], cos[nodes][group], rate[nodes][group], acceleration[nodes][group];
  double sin_start[group], cos_start[group], rate_start[group], acceleration_start[group];
};

// The last piece of each rig, like Piece for a single rig. A lane without a piece has zero length,
// and its numbers mean nothing.
struct alignas(64) LanePieces {
  double length[group];                           // s
  double position[2][group], velocity[3][group];  // at the start
  double guess[3][group];  // of the accelerations: those at the end of the last piece
  LaneAxis axis[model::most_servos];
  double gain[group];  // PlateMotion::gain
  LanePlane plane[2];
  double velocity_at[3][nodes][group], position_at[2][nodes][group];
  double acceleration_at[3][nodes][group];
  double series[3][nodes][group];
  double position_end[2][group], velocity_end[3][group];
  double contraction[group];  // of its iterations
  // The estimated local errors relative to the tolerance; a lane passes at 1 or below. `hopeless`
  // if substitution failed.
  double error[group];
  int iterations;  // of the last attempt, in all packs
  int servos;
  // The motion of each lane's plate behind a mechanism; null if the servos turn it directly.
  PlateMotion* plates;
};

inline constexpr double hopeless = 1e300;

// The servos of an axis in their present modes (model::held_motion). Their acceleration is push +
// by_command u - stiffness q - damping q'.
struct alignas(64) LaneServo {
  double push[group], by_command[group], stiffness[group], damping[group];
  double command[group];  // u
  // Bounds within which no servo switches, the square root of the stiffness, and its inverse
  // (model::ServoAxis::Clearance).
  double angle_most[group], rate_most[group], acceleration_most[group];
  double root[group], inverse_root[group];
};
struct alignas(64) LaneServos {
  LaneServo of[model::most_servos];
  double clear[group];  // 1 if no servo switches while the commands are held; otherwise 0
};

inline constexpr int rolling_numbers = sizeof(model::GeneralRolling) / sizeof(double);
// Lanes have no motors' loads.
inline constexpr int lane_quantity_count = Quantity::error_squared + 1;

struct alignas(64) LaneScene {
  double radius[group], gravity[group], friction[group];
  double rolling[rolling_numbers][group];  // the numbers of a model::GeneralRolling
  // For each Quantity up to the grip, the range in which no event occurs.
  double least[Quantity::grip + 1][group], most[Quantity::grip + 1][group];
  // For each quantity, the range in which a piece tells nothing new.
  double known_least[lane_quantity_count][group], known_most[lane_quantity_count][group];
  double rtol, atol;
  bool force, sizes;  // whether contact forces, and the sizes of motions, are wanted
  bool papers;        // whether all lanes have the paper's rolling
};

// Whether an event may occur. If sizes are wanted, also the quantities at the start and at all
// nodes but the first, and their ranges there.
struct alignas(64) LaneQuantities {
  double at[lane_quantity_count][nodes][group];
  double least[lane_quantity_count][group], most[lane_quantity_count][group];
  double quiet[group];  // 1 if bounds exclude every event; otherwise 0
  double known[group];  // 1 if bounds exclude that the piece tells something new; otherwise 0
};
// A reference (x, y) at the start and at all nodes but the first.
struct alignas(64) LaneReference {
  double common[2][nodes], at[2][nodes][group];
  bool shared;  // whether all lanes use `common`; otherwise each has its own
};

struct alignas(64) Lanes {
  double of[group];
};
// The controllers at a sample. A controller that does not see the ball keeps its memory and
// command.
struct LaneControl {
  model::SampledLaw<Lanes> law;
  model::SampledMemory<Lanes> memory;
  Lanes sees, is_first;     // 1 or 0
  Lanes elapsed;            // s
  Lanes seen[2], servo[4];  // m; rad and rad/s
  Lanes reference[2][3];    // value, rate and acceleration
  Lanes command[2];         // in: the last one; out: the new one
};

struct LaneKernels {
  // Fills the servo motions of an axis, a MotionTable for each lane, for pieces of `length` s. Uses
  // power series, which the lengths must suit (model::suits_series()).
  void (*tables)(LaneAxis& axis, const LaneServo& servo, const double* length);
  // Computes the servos' accelerations at the start of pieces, and whether they clear their limits.
  void (*start)(LanePieces& pieces, LaneServos& servos);
  // Solves for the balls over the pieces, from their starts, lengths and axes.
  void (*attempt)(LanePieces& pieces, const LaneScene& scene);
  void (*evaluate_quantities)(const LanePieces& pieces, const LaneScene& scene,
                              const LaneReference& reference, LaneQuantities& quantities);
  // The range of a lane's quantity over Chebyshev points (close_overshoot), and its trend.
  Range (*narrow)(const LaneQuantities& quantities, Quantity quantity, int lane);
  // The values of a reference (x, y) at the start and at all nodes but the first of a piece.
  void (*reference)(const model::SignalView& of, double from, double length, double (*at)[nodes]);
  // Computes the controllers' commands at a sample.
  void (*control)(LaneControl& control);
  // Evaluates x, y, x', y' and u of each lane at its own time after the start of its piece, s.
  void (*evaluate)(const LanePieces& pieces, const double* times, double (*ball)[group]);
};

// The kernels of an instruction set (kernels.cpp).
template <class Isa>
[[nodiscard]] const LaneKernels& lane_kernels();

// The kernels of the chosen instruction set. Throws InputError if the environment variable
// BBSIM_SIMD is set, but not to an instruction set of this processor.
[[nodiscard]] const LaneKernels& choose_lane_kernels();

}  // namespace bbsim::solve::sampled
