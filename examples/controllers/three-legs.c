/* SPDX-FileCopyrightText: 2026 the bbsim authors
 * SPDX-License-Identifier: BSD-3-Clause */

/* A plate on three equal legs with its own inverse kinematics, as a shared library: three-legs.yaml
 * names it.
 *
 *     cc -std=c99 -O2 -fPIC -shared -I include examples/controllers/three-legs.c \
 *         -o examples/controllers/libthree-legs.so -lm
 *     bbsim run examples/controllers/three-legs.yaml
 *
 * A PD law gives a tilt, and inverse kinematics turn it into an angle of each servo: 0 where the
 * plate is level, and growing as the horn rises. */
#define BBSIM_CONTROLLER_COMMANDS 3
#include <bbsim/controller.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

struct legs {
  double kp, kv, limit;                                     /* rad/m, rad s/m, rad */
  double radius_base, radius_plate, horn, rod, height;      /* m */
  double level;                                             /* the horns' elevation, rad */
  double filter, period, elapsed;                           /* s */
  int seen_any;
  double position[2], velocity[2];
  double command[3];
};

static __thread const char *last_error = NULL;

uint32_t bbsim_controller_abi(void) { return BBSIM_CONTROLLER_ABI; }

/* The elevation of the horn of the leg at this azimuth, for a tilt. */
static double elevation(const struct legs *of, double azimuth, double phi, double theta) {
  const double e[2] = {cos(azimuth), sin(azimuth)};
  const double n[3] = {sin(phi) * cos(theta), -sin(theta), cos(phi) * cos(theta)};
  const double w = 1 / (1 + n[2]), along = e[0] * n[0] + e[1] * n[1];
  /* The joints stay in their legs' planes, so the plate's center wanders. */
  const double wander = of->radius_plate * w *
                        (0.5 * e[0] * (n[1] * n[1] - n[0] * n[0]) + e[1] * n[0] * n[1]);
  /* The joint as seen from the servo's axis, outward and up. */
  const double x = wander + of->radius_plate * (1 - w * along * along) - of->radius_base;
  const double z = of->height - of->radius_plate * along;
  const double distance = hypot(x, z);
  const double cosine = (distance * distance + of->horn * of->horn - of->rod * of->rod) /
                        (2 * of->horn * distance);
  return atan2(z, x) - acos(cosine); /* of two solutions, the knee outward */
}

int bbsim_controller_reset(void *controller, const bbsim_setup *setup) {
  struct legs *legs = controller;
  memset(legs, 0, sizeof *legs);
  legs->kp = bbsim_parameter_or(setup, "kp", NAN);
  legs->kv = bbsim_parameter_or(setup, "kv", NAN);
  legs->limit = bbsim_parameter_or(setup, "tilt_limit", NAN);
  legs->radius_base = bbsim_parameter_or(setup, "radius_base", NAN);
  legs->radius_plate = bbsim_parameter_or(setup, "radius_plate", NAN);
  legs->horn = bbsim_parameter_or(setup, "horn", NAN);
  legs->rod = bbsim_parameter_or(setup, "rod", NAN);
  legs->height = bbsim_parameter_or(setup, "height", NAN);
  legs->level = elevation(legs, 0, 0, 0);
  legs->filter = setup->derivative_filter;
  legs->period = legs->elapsed = setup->period;
  if (setup->drives_acceleration != 4) {
    last_error = "it commands the servos of three legs: drives: legs";
    return 1;
  }
  if (setup->parameter_count != 8 || isnan(legs->kp + legs->kv + legs->limit + legs->level)) {
    last_error = "it takes kp, kv, tilt_limit, radius_base, radius_plate, horn, rod and height";
    return 1;
  }
  if (setup->column_count != 0) {
    last_error = "it gives no columns";
    return 1;
  }
  return 0;
}

void *bbsim_controller_create(const bbsim_setup *setup) {
  struct legs *legs = malloc(sizeof *legs);
  if (legs == NULL) {
    last_error = "out of memory";
  } else if (bbsim_controller_reset(legs, setup) != 0) {
    free(legs);
    legs = NULL;
  }
  return legs;
}

int bbsim_controller_step(void *controller, const bbsim_sample *sample, double command[3],
                          double *columns) {
  struct legs *legs = controller;
  (void)columns;
  if (sample->seen == 0) { /* the command stays */
    legs->elapsed += legs->period;
  } else {
    const double keep = legs->filter / (legs->filter + legs->elapsed);
    double tilt[2];
    int i;
    for (i = 0; i < 2; ++i) {
      const double moved = legs->seen_any ? sample->ball[i] - legs->position[i] : 0;
      legs->velocity[i] = keep * legs->velocity[i] + (1 - keep) * (moved / legs->elapsed);
      legs->position[i] = sample->ball[i];
      tilt[i] = legs->kp * (sample->reference[i] - legs->position[i]) +
                legs->kv * (sample->reference_rate[i] - legs->velocity[i]);
      if (i == 1) tilt[i] = 0 - tilt[i]; /* positive theta drives the ball towards -y */
      tilt[i] = fmin(fmax(tilt[i], -legs->limit), legs->limit);
    }
    for (i = 0; i < 3; ++i) {
      const double third = 2.0943951023931953; /* of a turn */
      legs->command[i] = elevation(legs, i * third, tilt[0], tilt[1]) - legs->level;
    }
    legs->seen_any = 1;
    legs->elapsed = legs->period;
  }
  memcpy(command, legs->command, sizeof legs->command);
  return 0;
}

void bbsim_controller_destroy(void *controller) { free(controller); }

const char *bbsim_controller_last_error(const void *controller) {
  (void)controller;
  return last_error;
}
