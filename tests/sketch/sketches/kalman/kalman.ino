// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A Kalman filter for each axis (position and velocity) and state feedback; the touch controller is an
// STMPE610 on SPI.
#include <SPI.h>
#include <Wire.h>
#include "Adafruit_STMPE610.h"
#include <Servo.h>

#define STMPE_CS 8
Adafruit_STMPE610 touch = Adafruit_STMPE610(STMPE_CS);
Servo servo[2];

typedef struct {
  float x, v;                // m, m/s
  float P00, P01, P10, P11;  // covariance
} Filter;

Filter fx = {0, 0, 1, 0, 0, 1};
Filter fy = {0, 0, 1, 0, 0, 1};

const float Q_x = 1e-7, Q_v = 1e-3, R = 4e-7;
const float G = 7.0;  // m/s^2 per radian: 5/7 g
const float k1 = 1.0, k2 = 0.75;
unsigned long last;
float ux = 0, uy = 0;

void predict(Filter &f, float u, float dt) {
  f.x += f.v * dt + 0.5 * G * u * dt * dt;
  f.v += G * u * dt;
  f.P00 += dt * (f.P10 + f.P01 + dt * f.P11) + Q_x;
  f.P01 += dt * f.P11;
  f.P10 += dt * f.P11;
  f.P11 += Q_v;
}

void correct(Filter *f, float z) {
  float S = f->P00 + R;
  float K0 = f->P00 / S, K1 = f->P10 / S;
  float y = z - f->x;
  f->x += K0 * y;
  f->v += K1 * y;
  float P00 = f->P00, P01 = f->P01;
  f->P00 -= K0 * P00;
  f->P01 -= K0 * P01;
  f->P10 -= K1 * P00;
  f->P11 -= K1 * P01;
}

void setup() {
  SerialUSB.begin(115200);
  if (!touch.begin()) {
    SerialUSB.println("no touch controller");
    while (1)
      ;
  }
  servo[0].attach(6);
  servo[1].attach(7);
  last = micros();
}

void loop() {
  unsigned long now = micros();
  if (now - last < 10000) return;
  float dt = (now - last) * 1e-6;
  last = now;
  predict(fx, ux, dt);
  predict(fy, uy, dt);
  if (touch.touched()) {
    uint16_t x, y;
    uint8_t z;
    while (!touch.bufferEmpty()) {
      touch.readData(&x, &y, &z);
      correct(&fx, (x - 2048) * 0.0001);
      correct(&fy, (y - 2048) * 0.0001);
    }
    touch.writeRegister8(STMPE_INT_STA, 0xFF);  // clears the chip's interrupts
  }
  ux = constrain(-k1 * fx.x - k2 * fx.v, -0.2, 0.2);
  uy = constrain(-k1 * fy.x - k2 * fy.v, -0.2, 0.2);
  servo[0].writeMicroseconds(1472 + ux * RAD_TO_DEG * 10.31);
  servo[1].writeMicroseconds(1472 - uy * RAD_TO_DEG * 10.31);
}
