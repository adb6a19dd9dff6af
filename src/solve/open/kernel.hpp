// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The driver's interface to a group of balls under given motions in lock step, for every
// instruction set.
//
// Has only plain data and pointers to functions. Code here could be compiled for one instruction
// set and run on another.
#pragma once

#include <cstddef>

#include "model/signals/signal_pair.hpp"

namespace bbsim::solve::open {

// The number of cases that step together. It is the same on every processor, so that a case has the
// same companions everywhere.
inline constexpr int group = 8;

inline constexpr int states = 5;  // of model::OpenLoop<Shape::full>: x, y, x', y', u = r gamma'

inline constexpr int most_harmonics = 8;

// A group's scenes, one per lane, in SI units. The angles (phi, theta) are start + rate t + sum of
// (sine sin(frequency t) + cosine cos(frequency t)), plus terms that all lanes share.
struct alignas(64) Scenes {
  double radius[group], gravity[group];
  double start[2][group], rate[2][group];
  struct Harmonic {
    double frequency[group], sine[2][group], cosine[2][group];
  } harmonics[most_harmonics];
  double initial[states][group];
  int harmonic_count;
  model::SharedTerms shared;
  bool small;  // whether all angles stay within pi/4
};

struct alignas(64) Attempt {
  // Squares of the estimated local errors relative to the tolerance; a lane passes at 1 or below.
  // NaN where the step is not finite.
  double error_squared[group];
  bool converged;
  int iterations;
};

// Extremes of the plate: 1 - cos(tilt), and the squared angular velocity, rad^2/s^2.
struct alignas(64) Turning {
  double versine[group], rate_squared[group];
};

// The functions work on a workspace of `workspace` bytes, aligned to 64, which start() prepares.
// None allocates or throws.
struct Kernel {
  int nodes;
  std::size_t workspace;
  void (*start)(void* workspace, const Scenes& scenes, double rtol, double atol);
  // Attempts a step of length h from the present states at t, both in s.
  void (*attempt)(void* workspace, double t, double h, Attempt& result);
  // Makes the end of the last attempt the present state. Updates the ball's greatest distance.
  void (*accept)(void* workspace);
  // Reads the present states, and the greatest squared distance so far of the contact point from
  // the plate's origin.
  void (*read)(const void* workspace, double (*state)[group], double* distance_squared);
  // Copies the scene and present state of lane `of` to `lane`.
  void (*twin)(void* workspace, int lane, int of);
};

struct Kernels {
  Kernel few, some, many;  // by the number of nodes
  // The sine and cosine of an angle in each lane.
  void (*directions)(const double* angles, double* sines, double* cosines);
  // The greatest values of a plate without shared terms, from t = 0 to `until` (s) of each lane.
  // Divides each lane's time into `intervals`.
  void (*turning)(const Scenes& scenes, const double* until, int intervals, Turning& greatest);
};

// The kernels of an instruction set (kernels.cpp).
template <class Isa>
[[nodiscard]] const Kernels& kernels();

// The kernels of the chosen instruction set. Throws InputError if the environment variable
// BBSIM_SIMD names no instruction set of this processor.
[[nodiscard]] const Kernels& choose_kernels();

}  // namespace bbsim::solve::open
