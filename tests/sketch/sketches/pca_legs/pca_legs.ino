// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Three legs turned by servos on a PCA9685, and a copy of a header that the board has.
#include <Adafruit_PWMServoDriver.h>
#include "TouchScreen.h"

Adafruit_PWMServoDriver pwm;
TouchScreen screen(A0, A1, A2, A3, 0);
float oldX, oldY, speedX, speedY;
unsigned long timer;

void turn(int leg, float angle) {  // radians, 0 where the plate is level
  pwm.writeMicroseconds(leg, 1472 + angle * 1856 / PI);
}

void setup() {
  pwm.begin();
  pwm.setOscillatorFrequency(25000000);
  pwm.setPWMFreq(50);
  for (int i = 0; i < 3; i++) turn(i, 0);
}

void loop() {
  if (micros() - timer < 20000UL) return;
  timer = micros();
  TSPoint p = screen.getPoint();
  float x = -(p.x - 511.5) * 0.0004, y = -(p.y - 511.5) * 0.0004;  // m
  speedX += 0.5 * ((x - oldX) / 0.02 - speedX);
  speedY += 0.5 * ((y - oldY) / 0.02 - speedY);
  oldX = x;
  oldY = y;
  float slopeX = constrain(-0.7 * x - 0.5 * speedX, -0.15, 0.15);
  float slopeY = constrain(-0.7 * y - 0.5 * speedY, -0.15, 0.15);
  for (int i = 0; i < 3; i++) {
    float azimuth = i * TWO_PI / 3;
    float rise = 0.1 * (-slopeX * cos(azimuth) - slopeY * sin(azimuth));
    turn(i, asin(constrain(rise / 0.05, -0.7, 0.7)));
  }
}
