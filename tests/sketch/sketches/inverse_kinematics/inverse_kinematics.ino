// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Two servos move the plate through horn, rod and arm; servo angles come from inverse kinematics.
// The servos are connected to a PCA9685, and the touch screen has 4 wires.
#include <Wire.h>
#include <Adafruit_PWMServoDriver.h>
#include "TouchScreen.h"

Adafruit_PWMServoDriver pwm = Adafruit_PWMServoDriver();
TouchScreen screen(A0, A1, A2, A3, 0);

#define SERVO_FREQ 50
#define USMIN 544
#define USMAX 2400

// cm, seen from the side, from the servo's axis: both bars point along x when the plate is level
const float HORN = 2.4, ARM = 6.0, DX = -1.6, DZ = 7.0;
float rod;

float ballX, ballY, oldX, oldY, speedX, speedY;
unsigned long timer;

// Servo angle for a plate angle, both in radians.
float inverse(float plate) {
  float px = DX + ARM * cos(plate), pz = DZ + ARM * sin(plate);
  float distance = sqrt(sq(px) + sq(pz));
  float k = (sq(distance) + sq(HORN) - sq(rod)) / (2 * HORN);
  return atan2(pz, px) - acos(constrain(k / distance, -1, 1));
}

void setServo(uint8_t number, float angle) {
  float us = 1472 + degrees(angle) * (USMAX - USMIN) / 180.0;
  pwm.writeMicroseconds(number, constrain(us, USMIN, USMAX));
}

void setup() {
  rod = sqrt(sq(DX + ARM - HORN) + sq(DZ));
  Wire.begin();
  pwm.begin();
  pwm.setOscillatorFrequency(27000000);
  pwm.setPWMFreq(SERVO_FREQ);
  Wire.setClock(400000);
  delay(10);
  setServo(0, 0);
  setServo(1, 0);
  timer = micros();
}

void loop() {
  if (micros() - timer < 20000UL) return;
  timer += 20000UL;
  TSPoint p = screen.getPoint();
  if (p.z < 10) return;
  ballX = -(p.x - 511.5) * 0.04;
  ballY = -(p.y - 511.5) * 0.04;
  speedX += 0.7 * ((ballX - oldX) / 0.02 - speedX);
  speedY += 0.7 * ((ballY - oldY) / 0.02 - speedY);
  oldX = ballX;
  oldY = ballY;
  float tiltX = radians(-0.7 * ballX - 0.45 * speedX);
  float tiltY = radians(-0.7 * ballY - 0.45 * speedY);
  tiltX = constrain(tiltX, radians(-12), radians(12));
  tiltY = constrain(tiltY, radians(-12), radians(12));
  setServo(0, inverse(tiltX));
  setServo(1, inverse(-tiltY));
}
