// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The driver's interface to one step of an ensemble of balls on the paper's rig, each at its own
// time, for every instruction set.
//
// Only plain data and pointers to functions: code here could be compiled for one instruction set
// and run on another.
#pragma once

#include <cstddef>
#include <limits>

#include "model/signals/signal_pair.hpp"

namespace bbsim::solve::ensemble {

// The number of cases that step together.
inline constexpr int group = 8;

inline constexpr int states = 9;  // of model::ClosedLoop<Shape::full, ...>
inline constexpr int velocities = 5;
inline constexpr int most_nodes = 16;
inline constexpr int most_harmonics = 8;
inline constexpr int spare_rows = 2 * group;  // beyond the rows of the grid

// Sizes of a motion whose greatest value over a run lanes find. They are smooth: squares instead of
// roots.
enum Size : int {
  versine,           // 1 - cos(tilt) of the plate
  rate_squared,      // of the plate's angular velocity, (rad/s)^2
  distance_squared,  // of the contact point from the plate's origin, m^2
  error_squared,     // of the contact point from the reference, m^2
  size_count
};

// What moves the gimbal: a given function of time, or a loop under equation (31), by accelerations
// or by the angles of servos.
enum class Actuation { given, by_acceleration, by_servo };

// One case, in SI units. The signals are the gimbal's angles (phi, theta) if these are given,
// otherwise the loop's reference (x, y). They are start + rate t + sum of (sine sin(frequency t) +
// cosine cos(frequency t)). Given angles may also have tables, which all cases share.
struct Case {
  double radius, gravity;
  double kv[2][2], kp[2][2];  // of a loop: rows phi, theta; columns x, y
  double omega_n, zeta;       // of its servo; not used if the loop drives accelerations
  double start[2], rate[2];
  model::Harmonic harmonics[most_harmonics];
  int harmonic_count;      // the others must be zero
  double initial[states];  // packed as in the loop; only the ball's if angles are given
  // When a given motion of the gimbal has shown all its tilts and rates, s.
  double repeats_after = std::numeric_limits<double>::infinity();
};
inline constexpr int numbers = offsetof(Case, harmonic_count) / sizeof(double);
inline constexpr int numbers_per_harmonic = sizeof(model::Harmonic) / sizeof(double);

// A case in progress: its state, its accelerations there, and the accelerations at the last step's
// nodes if they were kept.
struct Progress {
  Case of;
  double state[states];  // packed as in the loop
  double acceleration[velocities];
  double last_step;  // s; 0 if it was not kept
  double last_accelerations[most_nodes][velocities];
};

// The data that all cases share.
struct Shared {
  double rtol, atol;
  model::SharedTerms terms;  // splines of given angles
};

// Selects lanes: -1 (all bits) or 0.
struct alignas(64) Lanes {
  long long of[group];
};

// The greatest sizes of each lane.
struct alignas(64) Greatest {
  double of[size_count][group];
};

struct alignas(64) Attempt {
  // Squares of the estimated local errors relative to the tolerance; a lane passes at 1 or below.
  // NaN if the step is not finite.
  double error_squared[group];
  bool converged[group];
  int turns;  // iterations of the slowest lane
};

// The start and length of each lane's attempt, s.
struct alignas(64) Spans {
  double from[group], length[group];
};

// A lane's numbers depend only on its own case and steps, bit for bit, and not on its companions.
//
// All functions work on a workspace of `workspace` bytes, aligned to 64. start() must have prepared
// it, and load() must have filled every lane. None allocates or throws.
struct Kernel {
  Actuation actuation;
  int nodes;
  std::size_t workspace;
  void (*start)(void* workspace, const Shared& shared);
  // The fastest rate of each lane's motion at its present state and t = 0, 1/s. Lanes may be empty.
  void (*rates)(const void* workspace, double* rates);
  // Puts a case into a lane, and reads it back.
  void (*load)(void* workspace, int lane, const Progress& from);
  void (*store)(const void* workspace, int lane, Progress& into);
  // Attempts a step from the present states. No knot of a table may be within it.
  void (*attempt)(void* workspace, const Spans& spans, Attempt& result);
  // Evaluates x and y of a lane at times within the last attempt, on its polynomial. Call it before
  // accept(). May read up to `spare_rows` more times and write as many meaningless results: all
  // three arrays must have that space.
  void (*evaluate)(void* workspace, int lane, const double* times, std::size_t count, double* x,
                   double* y);
  // The sum of the squared distances of `count` rows from the reference of a loop. The arrays have
  // space as for evaluate().
  double (*squared_errors)(const Case& of, const double* times, std::size_t count, const double* x,
                           const double* y);
  // Updates the maxima with the last attempt, its start included: the ball's in `lanes`, and the
  // plate's in those also in `turning`. Call it for each accepted attempt, before accept().
  void (*raise_maxima)(void* workspace, const Lanes& lanes, const Lanes& turning,
                       Greatest& greatest);
  // Makes the end of the last attempt the present state of `lanes`. Lanes that are also in `kept`
  // keep the attempt's accelerations, from which a much shorter next step starts.
  void (*accept)(void* workspace, const Lanes& lanes, const Lanes& kept);
};

struct Kernels {
  int width;  // lanes of a pack
  Kernel of[7];
};

// The kernels of an instruction set (kernels.cpp).
template <class Isa>
[[nodiscard]] const Kernels& kernels();

// The kernel for an actuation and a number of nodes, which must exist.
[[nodiscard]] const Kernel& kernel_of(const Kernels& kernels, Actuation actuation, int nodes);

// The kernels of the chosen instruction set. Throws InputError if the environment variable
// BBSIM_SIMD is set, but not to an instruction set of this processor.
[[nodiscard]] const Kernels& choose_kernels();

}  // namespace bbsim::solve::ensemble
