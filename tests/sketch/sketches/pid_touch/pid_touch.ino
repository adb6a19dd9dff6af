// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Ball on plate: PID library, 4-wire resistive touch screen, two hobby servos.
#include <PID_v1.h>
#include <Servo.h>
#include <stdint.h>
#include "TouchScreen.h"

#define YP A2  // must be an analog pin
#define XM A3  // must be an analog pin
#define YM 8   // can be a digital pin
#define XP 9   // can be a digital pin

TouchScreen ts = TouchScreen(XP, YP, XM, YM, 300);

Servo servoX, servoY;

double setX = 0, inX, outX;
double setY = 0, inY, outY;
double Kp = 0.07, Ki = 0.02, Kd = 0.045;

PID pidX(&inX, &outX, &setX, Kp, Ki, Kd, DIRECT);
PID pidY(&inY, &outY, &setY, Kp, Ki, Kd, REVERSE);

const int LEVEL_X = 1472;
const int LEVEL_Y = 1472;
int lost = 0;

void setup() {
  Serial.begin(9600);
  servoX.attach(5);
  servoY.attach(6);
  servoX.writeMicroseconds(LEVEL_X);
  servoY.writeMicroseconds(LEVEL_Y);
  pidX.SetMode(AUTOMATIC);
  pidY.SetMode(AUTOMATIC);
  pidX.SetOutputLimits(-12, 12);
  pidY.SetOutputLimits(-12, 12);
  pidX.SetSampleTime(20);
  pidY.SetSampleTime(20);
  delay(500);
  Serial.println("Ready");
}

void loop() {
  TSPoint p = ts.getPoint();
  if (p.z > ts.pressureThreshhold) {
    // millimeters from the middle
    inX = map(p.x, 120, 903, 1600, -1600) / 10.0;
    inY = map(p.y, 150, 873, 1200, -1200) / 10.0;
    lost = 0;
    if (pidX.Compute()) servoX.writeMicroseconds(LEVEL_X + (int)(outX * 10.31));
    if (pidY.Compute()) servoY.writeMicroseconds(LEVEL_Y + (int)(outY * 10.31));
  } else if (++lost > 50) {
    servoX.writeMicroseconds(LEVEL_X);
    servoY.writeMicroseconds(LEVEL_Y);
  }
}
