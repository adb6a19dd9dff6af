// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The driver's interface to one step of Radau IIA collocation, for every instruction set.
//
// Only plain data and pointers to functions: code here could be compiled for one instruction set
// and run on another.
#pragma once

#include <cstddef>

namespace bbsim::solve::radau {

struct Start {
  const void* system;  // the system's view(), of the kernel's own type; must outlive the workspace
  const double* state;
  double rtol, atol;
  bool gamma;  // whether the integral of u is under error control too, and follows the states
};

enum class Verdict { converged, diverged, not_finite };

// The result of an attempted step.
struct Attempt {
  Verdict verdict;
  double error;  // estimated local error relative to the tolerance; the step passes at 1 or below
  int worst_state;  // the state with the largest error estimate
  int iterations;
  int right_hand_sides;
  int jacobians;
};

// The first part of every kernel's workspace.
struct WorkspaceHead {
  const void* system;  // not part of a saved state
  double rtol, atol;
  bool gamma;
  bool newton;     // whether to use Newton's iteration, not substitution
  bool has_guess;  // whether k has the values of the last attempt, over [t, t + h]
  bool accepted;   // whether that attempt was accepted
  bool expanded;   // whether its velocities and positions are series
};

// All functions work on a workspace of `workspace` bytes, aligned to 64, which start() prepares.
// None allocates or throws.
struct Kernel {
  int stages;
  int states;
  std::size_t workspace;
  void (*start)(void* workspace, const Start& start);
  // The rate of the system linearized about the present state, 1/s: the larger of its Jacobian's
  // norm for velocities and the square root of that for positions.
  double (*rate)(void* workspace, double t);
  // Attempts a step of length h from the present state at t, both in s.
  void (*attempt)(void* workspace, double t, double h, Attempt* result);
  // Makes the end of the last attempt the present state.
  void (*accept)(void* workspace);
  // Evaluates rows (states, and the integral of u if wanted) at times within the last attempt, on
  // its polynomial. Call it before accept().
  void (*evaluate)(void* workspace, const double* times, std::size_t count, double* rows);
  void (*state)(const void* workspace, double* state);
};

// One kernel for each system in model/systems/list.hpp, in its order.
inline constexpr int system_count = 17;

struct StepKernels {
  // If only the baseline supports a system, other sets have a kernel without functions.
  Kernel kernels[3][system_count];  // for 8, 12 and 16 stages
};

// The kernels of an instruction set (kernels.cpp).
template <class Isa>
[[nodiscard]] const StepKernels& kernels();

}  // namespace bbsim::solve::radau
