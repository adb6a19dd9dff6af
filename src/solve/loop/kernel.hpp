// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// One step of a group of closed loops, each at its own time: what the driver sees of it, whatever
// the instruction set.
//
// Plain data and pointers to functions only; nothing here may become code that two instruction
// sets share.
#pragma once

#include <cstddef>

namespace bbsim::solve::loop {

// Loops that step together.
inline constexpr int group = 8;

inline constexpr int states = 9;  // of model::ClosedLoop<Shape::full, ...>
inline constexpr int velocities = 5;
inline constexpr int spare_rows = 2 * group;  // beyond those that are asked for

// One loop, in SI: model::ClosedLoop<Shape::full, ...> about a reference
// start + rate t + sine sin(frequency t) + cosine cos(frequency t), components x, y.
struct LoopCase {
  double radius, gravity;
  double kv[2][2], kp[2][2];  // rows phi, theta; columns x, y
  double omega_n, zeta;       // of the servo; not used where accelerations are driven
  double start[2], rate[2];
  double frequency, sine[2], cosine[2];
  double initial[states];  // as the loop packs its states
};

inline constexpr int most_nodes = 12;

// A loop on its way: where it is, its accelerations there, and maybe those at its last step's
// nodes.
struct LoopState {
  LoopCase loop;
  double state[states];  // as the loop packs them
  double acceleration[velocities];
  double last_step;  // s; 0 where that is not kept
  double last_accelerations[most_nodes][velocities];
};

// A group's loops, one a lane: LoopCase's numbers, each in every lane.
struct alignas(64) Loops {
  double radius[group], gravity[group];
  double kv[2][2][group], kp[2][2][group];
  double omega_n[group], zeta[group];
  double start[2][group], rate[2][group];
  double frequency[group], sine[2][group], cosine[2][group];
  double initial[states][group];
};
static_assert(sizeof(Loops) == group * sizeof(LoopCase));

// Which lanes take part: -1, for all bits, or 0.
struct alignas(64) Lanes {
  long long of[group];
};

// What is looked at, each in every lane: 1 - cos(tilt) of the plane, the square of its angular
// velocity, and those of the contact point's distances from the plane's origin and from the
// reference.
enum Look : int { versine, rate_squared, distance_squared, error_squared, looks };

struct alignas(64) Greatest {
  double of[looks][group];
};

struct alignas(64) Attempt {
  // Squares of the estimated local errors in the tolerances' weights, at most 1 if good; no number
  // where the step is not finite.
  double error_squared[group];
  bool converged[group];
  int turns;  // of Newton's iteration, of the lane that took most
};

// What the accelerations of the ball and of the servos are by each other and by the states: the
// greatest sum of a row of the Jacobian's block, SI. Turning is the gimbal's acceleration.
struct alignas(64) Couplings {
  double ball_by_turning[group];
  double ball_by_velocity[group], ball_by_place[group], ball_by_rate[group], ball_by_angle[group];
  double servo_by_velocity[group], servo_by_place[group], servo_by_rate[group],
      servo_by_angle[group];
};

// When each lane's attempt starts, and how long it is, s.
struct alignas(64) Spans {
  double from[group], length[group];
};

// A lane's numbers depend on its own loop and steps alone, whatever its companions are, to the bit.
//
// All functions but couplings() work on a workspace of `workspace` bytes, aligned to 64, prepared
// by start() and loaded in every lane. None allocates or throws.
struct Kernel {
  int nodes;
  std::size_t workspace;
  void (*start)(void* workspace, double rtol, double atol);
  // Of the loops about their initial states, at t = 0.
  void (*couplings)(const Loops& loops, Couplings& result);
  // Puts a loop into a lane, and takes it from there.
  void (*load)(void* workspace, int lane, const LoopState& from);
  void (*store)(const void* workspace, int lane, LoopState& into);
  // Attempts a step from the present states.
  void (*attempt)(void* workspace, const Spans& spans, Attempt& result);
  // x and y of a lane at times within the last attempt, by its polynomial, before accept(). There
  // are `spare_rows` times more, and room for what is then put there, which means nothing.
  void (*evaluate)(void* workspace, int lane, const double* times, std::size_t count, double* x,
                   double* y);
  // Raises what is greatest, in some lanes, to what it is at the start and over the last attempt.
  // To be called before accept(), of each one that is accepted.
  void (*look)(void* workspace, const Lanes& lanes, Greatest& greatest);
  // Makes the end of the last attempt the present state of some lanes. Those of them that are
  // `kept` keep the attempt's accelerations, with which one that is much shorter then begins.
  void (*accept)(void* workspace, const Lanes& lanes, const Lanes& kept);
};

// By what the loop drives and the number of nodes.
struct Kernels {
  int width;  // lanes of a pack
  struct Nodes {
    Kernel few, many;
  } acceleration, angle;
};

// Those of the instruction set that was chosen. Throws InputError if the environment variable
// BBSIM_SIMD names none of this processor.
[[nodiscard]] const Kernels& choose_kernels();

}  // namespace bbsim::solve::loop
