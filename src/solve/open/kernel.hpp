// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A group of balls under given motions, in lock step: what the driver sees of it, whatever the
// instruction set.
//
// Plain data and pointers to functions only; nothing here may become code that two instruction
// sets share.
#pragma once

#include <cstddef>

#include "model/signals/signal_pair.hpp"

namespace bbsim::solve::open {

// Cases that step together; the same on every processor, so that each has the same companions
// everywhere.
inline constexpr int group = 8;

inline constexpr int states = 5;  // of model::OpenLoop<Shape::full>: x, y, x', y', u = r gamma'

inline constexpr int most_harmonics = 8;

// A group's scenes, one a lane, in SI. The angles are
// start + rate t + sum of (sine sin(frequency t) + cosine cos(frequency t)), plus tables that are
// the same in all lanes; phi, theta.
struct alignas(64) Scenes {
  double radius[group], gravity[group];
  double start[2][group], rate[2][group];
  struct Harmonic {
    double frequency[group], sine[2][group], cosine[2][group];
  } harmonics[most_harmonics];
  double initial[states][group];
  int harmonic_count;
  const model::Tabulated* tables;
  std::size_t table_count;
  bool small;  // no angle gets beyond a quarter of pi
};

struct alignas(64) Attempt {
  // Squares of the estimated local errors in the tolerance's weights, at most 1 if good; no number
  // where the step is not finite.
  double error_squared[group];
  bool converged;
  int iterations;
};

// What is looked at: 1 - cos(tilt), the square of the plane's angular velocity.
struct alignas(64) Turning {
  double versine[group], rate_squared[group];
};

// All functions but the last work on a workspace of `workspace` bytes, aligned to 64, prepared by
// start(). None allocates or throws.
struct Kernel {
  int nodes;
  std::size_t workspace;
  void (*start)(void* workspace, const Scenes& scenes, double rtol, double atol);
  // Attempts a step from the present states at t over h.
  void (*attempt)(void* workspace, double t, double h, Attempt& result);
  // Makes the end of the last attempt the present state, and looks how far the ball got on the way.
  void (*accept)(void* workspace);
  // The present states, and the greatest square of the contact point's distance from the plane's
  // origin so far.
  void (*read)(const void* workspace, double (*state)[group], double* distance_squared);
  // Makes one lane a twin of another: its scene and its present state.
  void (*twin)(void* workspace, int lane, int of);
};

struct Kernels {
  Kernel few, some, many;  // by the number of nodes
  // sin and cos of an angle in each lane.
  void (*directions)(const double* angles, double* sines, double* cosines);
  // What the planes, without tables, are greatest at from t = 0 until a time of each lane, s, which
  // is cut into so many intervals.
  void (*turning)(const Scenes& scenes, const double* until, int intervals, Turning& greatest);
};

// Those of the instruction set that was chosen. Throws InputError if the environment variable
// BBSIM_SIMD names none of this processor.
[[nodiscard]] const Kernels& choose_kernels();

}  // namespace bbsim::solve::open
