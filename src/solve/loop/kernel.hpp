// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The driver's interface to one step of a group of closed loops, each at its own time, for every
// instruction set.
//
// Has only plain data and pointers to functions. Code here could be compiled for one instruction
// set and run on another.
#pragma once

#include <cstddef>

namespace bbsim::solve::loop {

// The number of loops that step together.
inline constexpr int group = 8;

inline constexpr int states = 9;  // of model::ClosedLoop<Shape::full, ...>
inline constexpr int velocities = 5;
inline constexpr int spare_rows = 2 * group;  // beyond the rows of the grid

// One loop, in SI units: model::ClosedLoop<Shape::full, ...>. Its reference (x, y) is start + rate
// t + sine sin(frequency t) + cosine cos(frequency t).
struct LoopCase {
  double radius, gravity;
  double kv[2][2], kp[2][2];  // rows phi, theta; columns x, y
  double omega_n, zeta;       // of the servo; not used if the loop drives accelerations
  double start[2], rate[2];
  double frequency, sine[2], cosine[2];
  double initial[states];  // as the loop packs its states
};

inline constexpr int most_nodes = 12;

// A loop in progress: its state, its accelerations there, and the accelerations at the last step's
// nodes if they were kept.
struct LoopState {
  LoopCase loop;
  double state[states];  // as the loop packs them
  double acceleration[velocities];
  double last_step;  // s; 0 if it was not kept
  double last_accelerations[most_nodes][velocities];
};

// A group's loops, one per lane: the numbers of LoopCase, each for all lanes.
struct alignas(64) Loops {
  double radius[group], gravity[group];
  double kv[2][2][group], kp[2][2][group];
  double omega_n[group], zeta[group];
  double start[2][group], rate[2][group];
  double frequency[group], sine[2][group], cosine[2][group];
  double initial[states][group];
};
static_assert(sizeof(Loops) == group * sizeof(LoopCase));

// Selects lanes: -1 (all bits) or 0.
struct alignas(64) Lanes {
  long long of[group];
};

// Maxima, each in every lane: 1 - cos(tilt) of the plate, its squared angular velocity, and the
// squared distances of the contact point from the plate's origin and from the reference.
enum Look : int { versine, rate_squared, distance_squared, error_squared, looks };

struct alignas(64) Greatest {
  double of[looks][group];
};

struct alignas(64) Attempt {
  // Squares of the estimated local errors relative to the tolerance; a lane passes at 1 or below.
  // NaN where the step is not finite.
  double error_squared[group];
  bool converged[group];
  int turns;  // Newton iterations of the slowest lane
};

// Couplings of the accelerations of the ball and the servos with each other and with the states:
// the largest row sum of the Jacobian's block, in SI units. "turning" is the gimbal's acceleration.
struct alignas(64) Couplings {
  double ball_by_turning[group];
  double ball_by_velocity[group], ball_by_place[group], ball_by_rate[group], ball_by_angle[group];
  double servo_by_velocity[group], servo_by_place[group], servo_by_rate[group],
      servo_by_angle[group];
};

// The start and length of each lane's attempt, s.
struct alignas(64) Spans {
  double from[group], length[group];
};

// A lane's numbers depend only on its own loop and steps, to the bit, whatever its companions are.
//
// All functions but couplings() work on a workspace of `workspace` bytes, aligned to 64. start()
// must have prepared it, and load() must have filled every lane. None allocates or throws.
struct Kernel {
  int nodes;
  std::size_t workspace;
  void (*start)(void* workspace, double rtol, double atol);
  // Of the loops at their initial states and t = 0.
  void (*couplings)(const Loops& loops, Couplings& result);
  // Puts a loop into a lane, and reads it back.
  void (*load)(void* workspace, int lane, const LoopState& from);
  void (*store)(const void* workspace, int lane, LoopState& into);
  // Attempts a step from the present states.
  void (*attempt)(void* workspace, const Spans& spans, Attempt& result);
  // Evaluates x and y of a lane at times within the last attempt, on its polynomial. Call it before
  // accept(). May read up to `spare_rows` more times and write as many meaningless results: all
  // three arrays must have that space.
  void (*evaluate)(void* workspace, int lane, const double* times, std::size_t count, double* x,
                   double* y);
  // Updates the maxima of `lanes` with the start and the whole of the last attempt. Call it for
  // each accepted attempt, before accept().
  void (*look)(void* workspace, const Lanes& lanes, Greatest& greatest);
  // Makes the end of the last attempt the present state of `lanes`. Lanes that are also in `kept`
  // keep the attempt's accelerations, from which a much shorter next step starts.
  void (*accept)(void* workspace, const Lanes& lanes, const Lanes& kept);
};

// By the type of drive and the number of nodes.
struct Kernels {
  int width;  // lanes of a pack
  struct Nodes {
    Kernel few, many;
  } acceleration, angle;
};

// The kernels of an instruction set (kernels.cpp).
template <class Isa>
[[nodiscard]] const Kernels& kernels();

// The kernels of the chosen instruction set. Throws InputError if the environment variable
// BBSIM_SIMD names no instruction set of this processor.
[[nodiscard]] const Kernels& choose_kernels();

}  // namespace bbsim::solve::loop
