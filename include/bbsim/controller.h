/* SPDX-FileCopyrightText: 2026 the bbsim authors
 * SPDX-License-Identifier: BSD-3-Clause */

/* One's own controller of bbsim, as a shared library.
 *
 * A scenario names the library (docs/reference/controllers.md):
 *
 *     controller:
 *       library: {file: ./libpid.so, parameters: {kp: 0.7, ki: 0.35}}
 *       drives: angle
 *       reference: {point: ["3 cm", 0]}
 *       sampling: {period: "20 ms"}
 *
 * bbsim opens it, asks for its version, creates a controller, and has it step once a sample: time
 * stands still meanwhile. A library defines the functions below, three of which may be left out;
 * C99 is enough.
 * Build it with, say,
 *
 *     cc -std=c99 -O2 -fPIC -shared -I PREFIX/include pid.c -o libpid.so
 *
 * All numbers are in SI units and radians. Rows and pairs are (x, y) of the ball, in the plane's
 * frame, and (phi, theta) of the gimbal.
 *
 * A function that calls exit() is left there, and has failed: what it had on its stack is not
 * destroyed.
 *
 * In a sweep each thread creates a controller of its own, and threads call at the same time, each
 * with its own controller: what a library remembers belongs into what create() returns, not into
 * global variables. Calls with one controller never overlap. */
#ifndef BBSIM_CONTROLLER_H
#define BBSIM_CONTROLLER_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The version of all that stands here. It grows when a library that was compiled with an older
 * header would no longer work; bbsim refuses a library of another version. */
#define BBSIM_CONTROLLER_ABI 1u

/* How many commands there are. A library for three legs, under drives: legs, defines it as 3 before
 * it includes this file. */
#ifndef BBSIM_CONTROLLER_COMMANDS
#define BBSIM_CONTROLLER_COMMANDS 2
#endif

/* Before a function that bbsim has to find, for compilers that hide what is not marked. */
#if defined(__GNUC__) || defined(__clang__)
#define BBSIM_CONTROLLER_EXPORT __attribute__((visibility("default")))
#else
#define BBSIM_CONTROLLER_EXPORT
#endif

/* One of controller.library.parameters, in the order of the scenario. */
typedef struct bbsim_parameter {
  const char *name; /* ends with a zero */
  double value;     /* finite */
} bbsim_parameter;

/* What a run is like. Pointers in it hold for the call alone: copy what they point to. */
typedef struct bbsim_setup {
  uint32_t abi;                      /* BBSIM_CONTROLLER_ABI of bbsim */
  uint32_t drives_acceleration;      /* commands are 0: angles, rad; 1: accelerations, rad/s^2;
                                      * 2: torques, N m; 3: voltages, V; 4: angles of the servos
                                      * of three legs, rad */
  double period;                     /* from sample to sample, s, > 0 */
  double delay;                      /* from a sample to its command, s: sampling.delay */
  double resolution;                 /* that commands are rounded to; 0: none */
  double derivative_filter;          /* sampling.derivative_filter, s: yours to use, or not */
  double limit;                      /* commands are kept within it; infinite: none */
  double end;                        /* of the run, s */
  size_t parameter_count;            /* of the next */
  const bbsim_parameter *parameters; /* a null pointer if there are none */
  size_t column_count;               /* of the next */
  const char *const *columns; /* names, in output.columns, of numbers that you are to give at each
                                 step; a null pointer if there are none */
} bbsim_setup;

/* What is known at a sample. */
typedef struct bbsim_sample {
  uint64_t number;                  /* 0, 1, 2, ... */
  double t;                         /* number * period, s */
  double seen;                      /* 1: the sensor saw the ball; 0: it did not */
  double ball[2];                   /* x, y as the sensor saw them, m; 0, 0 if it did not */
  double reference[2];              /* where the ball is to be, m */
  double reference_rate[2];         /* its first derivative, m/s */
  double reference_acceleration[2]; /* its second derivative, m/s^2 */
  double servo[2];                  /* angles of the servos (of the gimbal, without them), rad */
  double servo_rate[2];             /* their rates, rad/s */
  double third_servo;               /* where the commands are those of three servos, the third's */
  double third_servo_rate;          /* angle and rate; 0 otherwise */
} bbsim_sample;

/* Returns BBSIM_CONTROLLER_ABI, of the header that the library was compiled with. */
BBSIM_CONTROLLER_EXPORT uint32_t bbsim_controller_abi(void);

/* Makes a controller for a run. Returns what the other functions are given, or a null pointer if
 * there can be none: bbsim then says what bbsim_controller_last_error(NULL) returns, and ends with
 * exit code 2. Refuse parameters and columns that you do not know: they may be misspelt. */
BBSIM_CONTROLLER_EXPORT void *bbsim_controller_create(const bbsim_setup *setup);

/* A sample. Writes the commands for phi and theta, which have to be finite, and, of each of
 * setup->columns, a number into `columns`, in their order. Where drives_acceleration is 4, there are
 * three commands: one for each servo. Returns 0; any other number ends the run with exit code 1, and
 * bbsim says what bbsim_controller_last_error() returns. */
BBSIM_CONTROLLER_EXPORT int bbsim_controller_step(void *controller, const bbsim_sample *sample,
                                                  double command[BBSIM_CONTROLLER_COMMANDS],
                                                  double *columns);

/* Another run begins, perhaps with another setup: the controller is to be as if it had just been
 * created. Returns 0 if it is; otherwise bbsim destroys it and creates another. This function may
 * be left out, and then is as if it never could. */
BBSIM_CONTROLLER_EXPORT int bbsim_controller_reset(void *controller, const bbsim_setup *setup);

/* Writes what the controller remembers into `bytes`, if there is room for it, and returns how many
 * bytes it takes; 0: that cannot be said, as bbsim_controller_last_error() tells. A call with a room
 * of 0 only asks how many. For `bbsim run --save-state`; may be left out, with the next. */
BBSIM_CONTROLLER_EXPORT size_t bbsim_controller_save(const void *controller, void *bytes,
                                                     size_t room);

/* A run goes on: the controller, just created or reset, is to remember what another one of the same
 * setup has written so. Returns 0; any other number ends the run, as it does for a step. */
BBSIM_CONTROLLER_EXPORT int bbsim_controller_restore(void *controller, const void *bytes,
                                                     size_t size);

/* The controller is no longer needed. */
BBSIM_CONTROLLER_EXPORT void bbsim_controller_destroy(void *controller);

/* What went wrong with the last call for this controller, or, for a null pointer, with the last
 * create() of this thread; a text that stays until the next call. A null pointer says nothing. */
BBSIM_CONTROLLER_EXPORT const char *bbsim_controller_last_error(const void *controller);

/* The value of the parameter of that name; `otherwise` if there is none. For create() and reset().
 */
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
