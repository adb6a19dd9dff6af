// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Three legs turned by stepper motors. setup() homes each against its limit switch, then raises the
// plate to level. The legs ramp to each target.
#include <math.h>
#include "TouchScreen.h"

TouchScreen screen(A0, A1, A2, A3, 0);
const int STEP[] = {2, 3, 4}, DIR[] = {5, 6, 7}, HOME[] = {10, 11, 12};
const int MODE[] = {22, 23, 24};  // the drivers' microstep pins
const float PER_RADIAN = 3200 / TWO_PI;

// As AccelStepper does it: the time between steps follows the speed, which the distance limits.
struct Leg {
  long at = 0, target = 0;
  float speed = 0;  // steps/s
  unsigned long last = 0;
} legs[3];
const float FASTEST = 4000, GAIN = 40000;

void pulse(int i, bool forward) {
  digitalWrite(DIR[i], forward ? HIGH : LOW);
  digitalWrite(STEP[i], HIGH);
  delayMicroseconds(2);
  digitalWrite(STEP[i], LOW);
  legs[i].at += forward ? 1 : -1;
}

void run(int i) {
  Leg& leg = legs[i];
  long left = leg.target - leg.at;
  if (left == 0 && fabs(leg.speed) < 300) {
    leg.speed = 0;
    return;
  }
  unsigned long now = micros();
  float dt = (now - leg.last) * 1e-6;
  float wish = left > 0 ? 1 : -1;
  wish *= min(FASTEST, sqrtf(2 * GAIN * labs(left)));
  float next = leg.speed + constrain(wish - leg.speed, -GAIN * dt - 300, GAIN * dt + 300);
  if (dt < 1 / max(fabsf(next), 100.f)) return;
  leg.speed = next;
  leg.last = now;
  if (leg.speed != 0) pulse(i, leg.speed > 0);
}

void setup() {
  for (int i = 0; i < 3; i++) {
    pinMode(STEP[i], OUTPUT);
    pinMode(DIR[i], OUTPUT);
    pinMode(MODE[i], OUTPUT);
    digitalWrite(MODE[i], HIGH);
    pinMode(HOME[i], INPUT_PULLUP);
    while (digitalRead(HOME[i]) == HIGH) {
      pulse(i, false);
      delay(1);
    }
    legs[i].at = 0;
    for (int n = 0; n < 178; n++) {  // 20.025 degrees up to level
      pulse(i, true);
      delay(1);
    }
    legs[i].at = legs[i].target = 0;
  }
}

float oldX, oldY;
unsigned long timer;

void loop() {
  for (int i = 0; i < 3; i++) run(i);
  if (micros() - timer < 20000UL) return;
  timer = micros();
  TSPoint p = screen.getPoint();
  float x = -(p.x - 511.5) * 0.0004, y = -(p.y - 511.5) * 0.0004;  // m
  float ax = -2.0 * x - 1.3 * (x - oldX) / 0.02, ay = -2.0 * y - 1.3 * (y - oldY) / 0.02;
  oldX = x;
  oldY = y;
  // Slopes of the plate, and the rise of each joint at 0.1 m; the horns are 5 cm.
  ax = constrain(ax, -0.2, 0.2);
  ay = constrain(ay, -0.2, 0.2);
  for (int i = 0; i < 3; i++) {
    float azimuth = i * TWO_PI / 3;
    float rise = 0.1 * (-ax * cos(azimuth) - ay * sin(azimuth));
    legs[i].target = lround(asin(constrain(rise / 0.05, -0.7, 0.7)) * PER_RADIAN);
  }
}
