/* A controller for bbsim, with a PID for each axis. It moves the ball of the example "step" to its
 * reference:
 *
 *     cc -O2 -fPIC -shared -I PREFIX/include controller.c -o controller.so
 *     bbsim examples step
 *     bbsim run step.yaml --set controller.pid=null --set controller.library.file=controller.so
 *
 * PREFIX is where bbsim is installed. `bbsim check`, with the same --set, says where its commands
 * drive the ball. bbsim/controller.h says what each function is for. */
#include <bbsim/controller.h>
#include <stdlib.h>

static const double kp = 0.7, ki = 0.35, kd = 0.6; /* rad/m, rad/(m s), rad s/m */
static const double filter = 0.04;                 /* s, of the velocity */
static const double limit = 0.2;                   /* rad */

struct axis {
  double last, velocity, integral;
};

/* All of its memory, since a sweep runs several controllers at the same time. */
struct controller {
  double period; /* s */
  int seen_any;
  struct axis x, y;
  double command[2];
};

uint32_t bbsim_controller_abi(void) { return BBSIM_CONTROLLER_ABI; }

void *bbsim_controller_create(const bbsim_setup *setup) {
  struct controller *c = calloc(1, sizeof *c);
  if (c != NULL) c->period = setup->period;
  return c;
}

/* The tilt, in rad, that drives the ball from its position to the reference, in m. */
static double command(const struct controller *c, struct axis *axis, double position,
                      double reference) {
  const double dt = c->period, error = reference - position;
  double tilt;
  if (c->seen_any) {
    axis->velocity += dt / (filter + dt) * ((position - axis->last) / dt - axis->velocity);
  }
  axis->last = position;
  tilt = kp * error + axis->integral - kd * axis->velocity;
  if (tilt > limit) return limit;
  if (tilt < -limit) return -limit;
  axis->integral += ki * error * dt; /* not at the limit, where it would wind up */
  return tilt;
}

int bbsim_controller_step(void *controller, const bbsim_sample *sample, double commands[2],
                          double *columns) {
  struct controller *c = controller;
  (void)columns;          /* numbers of your own, if output.columns asks for any */
  if (sample->seen != 0) { /* else the sensor missed the ball: hold the command */
    /* Positive phi drives the ball towards +x, positive theta towards -y. */
    c->command[0] = command(c, &c->x, sample->ball[0], sample->reference[0]);
    c->command[1] = -command(c, &c->y, sample->ball[1], sample->reference[1]);
    c->seen_any = 1;
  }
  commands[0] = c->command[0];
  commands[1] = c->command[1];
  return 0;
}

void bbsim_controller_destroy(void *controller) { free(controller); }

const char *bbsim_controller_last_error(const void *controller) {
  (void)controller;
  return "out of memory";
}
