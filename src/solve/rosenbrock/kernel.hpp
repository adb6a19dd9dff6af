// One step of a group of closed loops in lock step: what the driver sees of it, whatever the
// instruction set.
//
// Plain data and pointers to functions only; nothing here may become code that two instruction
// sets share.
#pragma once

#include <cstddef>

namespace bbsim::solve::rosenbrock {

// Loops that step together; the same on every processor, so that each run of a study has the same
// companions everywhere.
inline constexpr int group = 8;

inline constexpr int states = 9;  // of model::ClosedLoop<Shape::full, ...>

// A group's loops, one a lane, in SI. The reference is
// start + rate t + sine sin(frequency t) + cosine cos(frequency t), components x, y.
struct alignas(64) Loops {
  double radius[group], gravity[group];
  double kv[2][2][group], kp[2][2][group];
  double omega_n[group], zeta[group];
  double start[2][group], rate[2][group];
  double frequency[group], sine[2][group], cosine[2][group];
};

// What is looked at of a step, each in every lane: 1 - cos(tilt) of the plane, the square of its
// angular velocity, and those of the contact point's distances from the plane's origin and from the
// reference.
enum Look : int { versine, rate_squared, distance_squared, error_squared, looks };

struct alignas(64) Looks {
  double greatest[looks][group];  // at the ends of the steps so far
  double promise[looks][group];   // what it may be within the last step
};

// All functions work on a workspace of `workspace` bytes, aligned to 64, prepared by start(). None
// allocates or throws.
struct Kernel {
  std::size_t workspace;
  void (*start)(void* workspace, const Loops& loops, const double (*initial)[group], double rtol,
                double atol);
  // How fast each linearised loop moves about its present state, 1/s: the norm of its Jacobian,
  // positions counted by the root.
  void (*rate)(void* workspace, double t, double* rates);
  // Attempts a step from the present states at t over h. Errors are estimates in the tolerances'
  // weights, at most 1 if good, and NaN where the step is not finite.
  void (*attempt)(void* workspace, double t, double h, double* errors);
  // The states at times within the last attempt, by its polynomial: [time][state][lane], aligned
  // to 64. To be called before accept().
  void (*evaluate)(void* workspace, const double* times, std::size_t count, double* rows);
  // Looks at the last attempt; to be called before accept(), of each one that is accepted.
  // `greatest` is raised, `promise` set. Returns whether any lane promises something greater.
  bool (*look)(void* workspace, Looks* looks);
  // Makes the end of the last attempt the present state.
  void (*accept)(void* workspace);
  // Makes one lane a twin of another: its loop and its present state.
  void (*twin)(void* workspace, int lane, int of);
};

struct LaneKernels {
  int width;  // lanes of a pack
  Kernel acceleration, angle;
};

// Those of the instruction set that was chosen. Throws InputError if the environment variable
// BBSIM_SIMD names none of this processor.
[[nodiscard]] const LaneKernels& choose_kernels();

}  // namespace bbsim::solve::rosenbrock
