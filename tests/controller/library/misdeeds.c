/* SPDX-FileCopyrightText: 2026 the bbsim authors
 * SPDX-License-Identifier: BSD-3-Clause */

/* A library for tests; its parameter `mode` selects its behavior:
 * 0 normal; 1 no controller; 2 an error at sample 5; 3 NaN at sample 5; 4 like 0, without reset;
 * 5 exit(7) at sample 5; 13 a column of NaN there. MISDEED_ABI sets its version, MISDEED_NO_STEP
 * omits a function. */
#include <bbsim/controller.h>
#include <math.h>
#include <stdlib.h>

struct controller {
  double mode, samples;
};

static const char *last_error = NULL;

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
  made->mode = bbsim_parameter_or(setup, "mode", 0);
  if (made->mode != 1) return made;
  last_error = "no such mode";
  free(made);
  return NULL;
}

#ifndef MISDEED_NO_STEP
int bbsim_controller_step(void *controller, const bbsim_sample *sample, double command[2],
                          double *columns) {
  struct controller *of = controller;
  command[0] = 0.01;
  command[1] = -0.02;
  columns[0] = ++of->samples;
  if (sample->number != 5) return 0;
  if (of->mode == 5) exit(7);
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
  free(controller);
}

const char *bbsim_controller_last_error(const void *controller) {
  (void)controller;
  return last_error;
}
