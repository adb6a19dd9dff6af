// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// One step of Radau IIA collocation: what the driver sees of it, whatever the instruction set.
//
// Plain data and pointers to functions only; nothing here may become code that two instruction
// sets share.
#pragma once

#include <cstddef>

namespace bbsim::solve::radau {

struct Start {
  const void* system;  // the system's view(), of the kernel's own type; outlives the workspace
  const double* state;
  double rtol, atol;
  bool gamma;  // the integral of u is under the tolerance too, and follows the states in a row
  bool positions_only = false;  // without gamma: evaluate() leaves velocities as they are
};

enum class Verdict { converged, diverged, not_finite };

// What became of an attempted step.
struct Attempt {
  Verdict verdict;
  double error;     // estimated local error in the tolerance's weights: at most 1 is good
  int worst_state;  // the state with the largest estimate
  int iterations;
  int right_hand_sides;
  int jacobians;
};

// What a workspace begins with, whatever the kernel.
struct WorkspaceHead {
  const void* system;  // first, since it is no part of a state that is saved
  double rtol, atol;
  bool gamma;
  bool positions_only;  // in rows
  bool newton;          // iterate by Newton; otherwise by substitution
  bool has_guess;       // k holds the last attempt's values, over [t, t + h]
  bool accepted;        // whether that attempt was accepted
};

// All functions work on a workspace of `workspace` bytes, aligned to 64, prepared by start().
// None allocates or throws.
struct Kernel {
  int stages;
  int states;
  std::size_t workspace;
  void (*start)(void* workspace, const Start& start);
  // How fast the linearised system moves about the present state, 1/s: the norm of its Jacobian,
  // positions counted by the root.
  double (*rate)(void* workspace, double t);
  // Attempts a step from the present state at t over h.
  void (*attempt)(void* workspace, double t, double h, Attempt* result);
  // Makes the end of the last attempt the present state.
  void (*accept)(void* workspace);
  // The rows of states, and the integral of u, at times within the last attempt, by its
  // polynomial; to be called before accept().
  void (*evaluate)(void* workspace, const double* times, std::size_t count, double* rows);
  void (*state)(const void* workspace, double* state);
};

// One for each system of model/systems/list.hpp, in its order.
inline constexpr int system_count = 17;

struct StepKernels {
  // Of a system that only the baseline has kernels for, without functions.
  Kernel kernels[3][system_count];  // for 8, 12 and 16 stages
};

}  // namespace bbsim::solve::radau
