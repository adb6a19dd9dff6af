/* SPDX-FileCopyrightText: 2026 the bbsim authors
 * SPDX-License-Identifier: BSD-3-Clause */

/* A library for tests; its parameter `mode` selects its behavior:
 * 0 normal; 1 no controller; 2 an error at sample 5; 3 NaN at sample 5; 4 like 0, without reset;
 * 5 exit(0) at sample 5; 6 _exit(0) there; 7 exit(0) in create; 8 exit(0) in destroy; 9 a child
 * process that calls exit(9) at sample 5, then normal; 10 a thread that calls exit(0) at sample 5;
 * 12 err(0, ...) at sample 5, with which the C library itself ends the process; 13 a column of NaN
 * at sample 5.
 * MISDEED_ABI sets its version, MISDEED_NO_STEP omits a function, MISDEED_OPENED calls exit(0)
 * while the library is opened. */
#define _DEFAULT_SOURCE
#include <bbsim/controller.h>
#include <err.h>
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

struct controller {
  double mode, samples;
};

static const char *last_error = NULL;

/* Keeps controllers that exit() leaves undestroyed reachable, for leak checkers. */
static struct controller *volatile made_last[64];
static size_t made_so_far = 0;

#ifdef MISDEED_OPENED
__attribute__((constructor)) static void opened(void) { exit(0); }
#endif

uint32_t bbsim_controller_abi(void) {
#ifdef MISDEED_ABI
  return MISDEED_ABI;
#else
  return BBSIM_CONTROLLER_ABI;
#endif
}

void *bbsim_controller_create(const bbsim_setup *setup) {
  struct controller *made = calloc(1, sizeof *made);
  if (made == NULL) return NULL;
  made_last[made_so_far++ % 64] = made;
  made->mode = bbsim_parameter_or(setup, "mode", 0);
  if (made->mode == 7) exit(0);
  if (made->mode != 1) return made;
  last_error = "no such mode";
  free(made);
  return NULL;
}

#ifndef MISDEED_NO_STEP
static void *end(void *nothing) {
  (void)nothing;
  exit(0);
}

int bbsim_controller_step(void *controller, const bbsim_sample *sample, double command[2],
                          double *columns) {
  struct controller *of = controller;
  command[0] = 0.01;
  command[1] = -0.02;
  columns[0] = ++of->samples;
  if (sample->number != 5) return 0;
  if (of->mode == 5) exit(0);
  if (of->mode == 6) _exit(0);
  if (of->mode == 9) {
    const pid_t child = fork();
    int status = 0;
    if (child == 0) exit(9);
    if (waitpid(child, &status, 0) != child || WEXITSTATUS(status) != 9) return 7;
  }
  if (of->mode == 10) {
    pthread_t thread;
    if (pthread_create(&thread, NULL, end, NULL) == 0) pthread_join(thread, NULL);
  }
  if (of->mode == 12) err(0, "this is how it ends");
  if (of->mode == 2) last_error = "the plate is gone";
  if (of->mode == 3) command[1] = NAN;
  if (of->mode == 13) columns[0] = NAN;
  return of->mode == 2 ? 7 : 0;
}
#endif

int bbsim_controller_reset(void *controller, const bbsim_setup *setup) {
  struct controller *of = controller;
  of->mode = bbsim_parameter_or(setup, "mode", 0);
  of->samples = 0;
  return of->mode == 4 ? 1 : 0;
}

void bbsim_controller_destroy(void *controller) {
  if (((struct controller *)controller)->mode == 8) exit(0);
  free(controller);
}

const char *bbsim_controller_last_error(const void *controller) {
  (void)controller;
  return last_error;
}
