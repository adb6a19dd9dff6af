// One step of a group of closed loops in lock step: what the driver sees of it, whatever the
// instruction set.
//
// Plain data and pointers to functions only; nothing here may become code that two instruction
// sets share.
#pragma once

#include <cstddef>

namespace bbsim::solve::loop {

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
  int iterations;
};

// What the accelerations of the ball and of the servos are by each other and by the states: the
// greatest sum of a row of the Jacobian's block, SI. Turning is the gimbal's acceleration.
struct alignas(64) Couplings {
  double ball_by_turning[group];
  double ball_by_velocity[group], ball_by_place[group], ball_by_rate[group], ball_by_angle[group];
  double servo_by_velocity[group], servo_by_place[group], servo_by_rate[group],
      servo_by_angle[group];
};

// All functions work on a workspace of `workspace` bytes, aligned to 64, prepared by start(). None
// allocates or throws.
struct Kernel {
  int nodes;
  std::size_t workspace;
  void (*start)(void* workspace, const Loops& loops, const double (*initial)[group], double rtol,
                double atol);
  // Of the loops about their present states.
  void (*couplings)(const void* workspace, double t, Couplings& result);
  // Attempts a step from the present states at t over h.
  void (*attempt)(void* workspace, double t, double h, Attempt& result);
  // The states at times within the last attempt, by its polynomial: [time][state][lane], aligned
  // to 64; if `places_only`, there are x and y alone. To be called before accept().
  void (*evaluate)(void* workspace, const double* times, std::size_t count, bool places_only,
                   double* rows);
  // Raises what is greatest to what it is at the start and over the last attempt. To be called
  // before accept(), of each one that is accepted.
  void (*look)(void* workspace, Greatest& greatest);
  // Makes the end of the last attempt the present state.
  void (*accept)(void* workspace);
  // The present states, [state][lane].
  void (*read)(const void* workspace, double (*state)[group]);
  // Makes one lane a twin of another: its loop and its present state.
  void (*twin)(void* workspace, int lane, int of);
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
