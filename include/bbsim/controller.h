/* SPDX-FileCopyrightText: 2026 the bbsim authors
 * SPDX-License-Identifier: BSD-3-Clause */

/* Your own controller for bbsim, as a shared library.
 *
 * A scenario names the library (docs/reference/controllers.md):
 *
 *     controller:
 *       library: {file: ./libpid.so, parameters: {kp: 0.7, ki: 0.35}}
 *       drives: angle
 *       reference: {point: ["3 cm", 0]}
 *       sampling: {period: "20 ms"}
 *
 * bbsim opens the library, checks its version, creates a controller and calls its step function
 * once per sample. Simulated time stands still during the calls. A library defines the functions
 * below, in C99 or later; reset is optional. Build it like this:
 *
 *     cc -std=c99 -O2 -fPIC -shared -I PREFIX/include pid.c -o libpid.so
 *
 * All numbers are in SI units and radians. Pairs are (x, y) of the ball in the plane's frame, and
 * (phi, theta) of the gimbal.
 *
 * A library that calls exit() ends bbsim, and a library that crashes crashes it: return an error
 * instead.
 *
 * In a sweep, each thread creates its own controller, and threads call the library at the same
 * time. Keep state in what create() returns, not in global variables. Calls for one controller
 * never overlap. */
#ifndef BBSIM_CONTROLLER_H
#define BBSIM_CONTROLLER_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Version of this interface. It increases when libraries compiled with an older header no longer
 * work. bbsim refuses a library of another version. */
#define BBSIM_CONTROLLER_ABI 1u

/* Number of commands. A library for three legs (drives: legs) defines it as 3 before it includes
 * this file. */
#ifndef BBSIM_CONTROLLER_COMMANDS
#define BBSIM_CONTROLLER_COMMANDS 2
#endif

/* Exports a function, so that bbsim finds it even if the compiler hides functions by default. */
#if defined(__GNUC__) || defined(__clang__)
#define BBSIM_CONTROLLER_EXPORT __attribute__((visibility("default")))
#else
#define BBSIM_CONTROLLER_EXPORT
#endif

/* An entry of controller.library.parameters, in the order of the scenario. */
typedef struct bbsim_parameter {
  const char *name; /* zero-terminated */
  double value;     /* finite */
} bbsim_parameter;

/* Settings of a run. Its pointers are valid during the call only: copy what they point to. */
typedef struct bbsim_setup {
  uint32_t abi;                      /* BBSIM_CONTROLLER_ABI of bbsim */
  uint32_t drives_acceleration;      /* commands are 0: angles, rad; 1: accelerations, rad/s^2;
                                      * 2: torques, N m; 3: voltages, V; 4: servo angles of three
                                      * legs, rad */
  double period;                     /* time between samples, s, > 0 */
  double delay;                      /* from a sample to its command (sampling.delay), s */
  double resolution;                 /* step to which bbsim rounds commands; 0: none */
  double derivative_filter;          /* sampling.derivative_filter, s; bbsim does not apply it */
  double limit;                      /* largest command that both axes allow; infinite: none */
  double end;                        /* end of the run, s */
  size_t parameter_count;
  const bbsim_parameter *parameters; /* null if there are none */
  size_t column_count;
  const char *const *columns; /* names in output.columns of the numbers that each step writes; null
                                 if there are none */
} bbsim_setup;

/* Input of the controller at a sample. */
typedef struct bbsim_sample {
  uint64_t number;                  /* 0, 1, 2, ... */
  double t;                         /* number * period, s */
  double seen;                      /* 1: the sensor saw the ball; 0: it did not */
  double ball[2];                   /* measured x, y, m; 0, 0 if the sensor missed the ball */
  double reference[2];              /* where the ball should be, m */
  double reference_rate[2];         /* its first derivative, m/s */
  double reference_acceleration[2]; /* its second derivative, m/s^2 */
  double servo[2];                  /* servo angles (gimbal angles without servos), rad */
  double servo_rate[2];             /* their rates, rad/s */
  double third_servo;               /* angle of the third servo under drives: legs, rad */
  double third_servo_rate;          /* its rate, rad/s; both are 0 otherwise */
} bbsim_sample;

/* Returns the BBSIM_CONTROLLER_ABI of the header that the library was compiled with. */
BBSIM_CONTROLLER_EXPORT uint32_t bbsim_controller_abi(void);

/* Creates a controller for a run. Returns the pointer that the other functions receive, or null on
 * failure: bbsim then prints bbsim_controller_last_error(NULL) and ends with exit code 2. Refuse
 * unknown parameters and columns: they may be misspelled. */
BBSIM_CONTROLLER_EXPORT void *bbsim_controller_create(const bbsim_setup *setup);

/* Computes a sample. Writes finite commands for phi and theta (or for three servos, if
 * drives_acceleration is 4) to `command`, and a finite number for each of setup->columns, in
 * order, to `columns`. Returns 0. Any other number ends the run with exit code 1, and bbsim prints
 * bbsim_controller_last_error(). */
BBSIM_CONTROLLER_EXPORT int bbsim_controller_step(void *controller, const bbsim_sample *sample,
                                                  double command[BBSIM_CONTROLLER_COMMANDS],
                                                  double *columns);

/* Returns the controller to the state after create(), for another run, perhaps with another setup.
 * Returns 0 on success; otherwise bbsim destroys the controller and creates another. Optional: if
 * it is missing, bbsim always does so. */
BBSIM_CONTROLLER_EXPORT int bbsim_controller_reset(void *controller, const bbsim_setup *setup);

/* Frees the controller. */
BBSIM_CONTROLLER_EXPORT void bbsim_controller_destroy(void *controller);

/* Returns why the last call for this controller failed or, for a null pointer, the last create() of
 * this thread. The text stays valid until the next call. May return null. */
BBSIM_CONTROLLER_EXPORT const char *bbsim_controller_last_error(const void *controller);

/* Value of the parameter `name`, or `otherwise` if it is not given. For create() and reset(). */
static inline double bbsim_parameter_or(const bbsim_setup *setup, const char *name,
                                        double otherwise) {
  size_t i, k;
  for (i = 0; i < setup->parameter_count; ++i) {
    const char *given = setup->parameters[i].name;
    for (k = 0; given[k] != '\0' && given[k] == name[k]; ++k) {
    }
    if (given[k] == name[k]) return setup->parameters[i].value;
  }
  return otherwise;
}

#ifdef __cplusplus
}
#endif

#endif
