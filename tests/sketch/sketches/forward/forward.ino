// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Functions are used before they are defined, partly in another file, helpers.ino, and in src/.
#include <Servo.h>
#include "src/gains.h"

Servo servos[2];
Axis axes[2] = {{A0, 0, 0, 0}, {A1, 0, 0, 0}};
int pulses[2];

void loop() {
  if (!isTime(PERIOD)) return;
  for (int i = 0; i < 2; i++) {
    measure(axes[i]);
    pulses[i] = pulseFor(law(axes[i], KP, KD), i == 1);
  }
  move(pulses);
}

void setup() {
  attachAll(9, 10);
}

void attachAll(int first, int second) {
  servos[0].attach(first);
  servos[1].attach(second);
}

#ifdef NOT_DEFINED
void move(int *pulse) { neverCompiled(pulse); }
#else
void move(int *pulse) {
  for (int i = 0; i < 2; i++) servos[i].writeMicroseconds(pulse[i]);
}
#endif

// A "quoted { brace" and a comment with loop() { must not confuse the parser.
const char *text = "} void fake() {";

static bool isTime(unsigned long period) {
  static unsigned long next = 0;
  if (millis() < next) return false;
  next = next + period;
  return true;
}
