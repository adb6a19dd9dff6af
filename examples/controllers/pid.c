/* SPDX-FileCopyrightText: 2026 the bbsim authors
 * SPDX-License-Identifier: BSD-3-Clause */

/* The built-in PID of bbsim, as a shared library: library.yaml names it.
 *
 *     cc -std=c99 -O2 -ffp-contract=off -fPIC -shared -I include examples/controllers/pid.c \
 *         -o examples/controllers/libpid.so
 *     bbsim run examples/controllers/library.yaml
 *
 * gives the results of configs/step.yaml bit for bit. Without -ffp-contract=off, compilers may fuse a
 * product with a sum, and the results agree but for rounding. */
#include <bbsim/controller.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* One coordinate of the ball. */
struct axis {
  double position, velocity, integral;
};

struct pid {
  double kp, kv, ki, filter, limit, period;
  double periods, elapsed; /* since the ball was last seen; elapsed in s */
  int seen_any;
  struct axis axis[2];
  double command[2];
  size_t columns;
  int column[2]; /* the axis whose integral each column has */
};

static __thread const char *last_error = NULL;

uint32_t bbsim_controller_abi(void) { return BBSIM_CONTROLLER_ABI; }

int bbsim_controller_reset(void *controller, const bbsim_setup *setup) {
  struct pid *pid = controller;
  size_t i;
  memset(pid, 0, sizeof *pid);
  pid->kp = bbsim_parameter_or(setup, "kp", NAN);
  pid->kv = bbsim_parameter_or(setup, "kv", NAN);
  pid->ki = bbsim_parameter_or(setup, "ki", NAN);
  if (setup->parameter_count != 3 || isnan(pid->kp + pid->kv + pid->ki)) {
    last_error = "it takes the parameters kp, kv and ki";
    return 1;
  }
  pid->filter = setup->derivative_filter;
  pid->limit = setup->limit;
  pid->elapsed = pid->period = setup->period;
  pid->periods = 1;
  for (i = 0; i < setup->column_count; ++i) {
    const int x = strcmp(setup->columns[i], "x_integral") == 0;
    if (i == 2 || (!x && strcmp(setup->columns[i], "y_integral") != 0)) {
      last_error = "it gives the columns x_integral and y_integral";
      return 1;
    }
    pid->column[i] = x ? 0 : 1;
  }
  pid->columns = setup->column_count;
  return 0;
}

void *bbsim_controller_create(const bbsim_setup *setup) {
  struct pid *pid = malloc(sizeof *pid);
  if (pid == NULL) {
    last_error = "out of memory";
  } else if (bbsim_controller_reset(pid, setup) != 0) {
    free(pid);
    pid = NULL;
  }
  return pid;
}

static double law(const struct pid *pid, const struct axis *axis, double error, double rate) {
  return pid->kp * error + pid->kv * (rate - axis->velocity) + axis->integral;
}

/* The angle that takes a coordinate of the ball to its reference. */
static double command_of(struct pid *pid, struct axis *axis, double seen, double reference,
                         double rate) {
  const double keep = pid->filter / (pid->filter + pid->elapsed);
  const double difference = pid->seen_any ? (seen - axis->position) / pid->elapsed : 0;
  const double error = reference - seen;
  double before;
  axis->velocity = keep * axis->velocity + (1 - keep) * difference;
  axis->position = seen;
  before = law(pid, axis, error, rate);
  /* The integral waits while the command is at its limit and the error drives it outward. */
  if (!(fabs(before) >= pid->limit && pid->ki * error * before > 0)) {
    axis->integral += pid->elapsed * (pid->ki * error);
  }
  return law(pid, axis, error, rate);
}

int bbsim_controller_step(void *controller, const bbsim_sample *sample, double command[2],
                          double *columns) {
  struct pid *pid = controller;
  size_t i;
  if (sample->seen == 0) { /* the command stays */
    if (pid->seen_any) pid->elapsed = ++pid->periods * pid->period;
  } else {
    double u[2];
    int j;
    for (j = 0; j < 2; ++j) {
      u[j] = command_of(pid, &pid->axis[j], sample->ball[j], sample->reference[j],
                        sample->reference_rate[j]);
    }
    /* Positive phi drives the ball towards +x, positive theta towards -y. */
    pid->command[0] = u[0];
    pid->command[1] = 0 - u[1];
    pid->seen_any = 1;
    pid->periods = 1;
    pid->elapsed = pid->period;
  }
  memcpy(command, pid->command, sizeof pid->command);
  for (i = 0; i < pid->columns; ++i) columns[i] = pid->axis[pid->column[i]].integral;
  return 0;
}

void bbsim_controller_destroy(void *controller) { free(controller); }

const char *bbsim_controller_last_error(const void *controller) {
  (void)controller;
  return last_error;
}
