// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Another sketch wrote the calibration to the EEPROM; without it the plate stays level.
#include <EEPROM.h>
#include <Servo.h>

struct Calibration {
  char magic[4];
  int16_t xMin, xMax, yMin, yMax;  // of the touch controller, at the edges of the plate
  int16_t levelX, levelY;          // us
  float kp, kd;
};

Calibration cal;
Servo servoX, servoY;
float lastX, lastY;
boolean valid = false;

float millimeters(int raw, int low, int high, float size) {
  return (raw - (low + high) / 2.0) * size / (high - low);
}

void setup() {
  Serial.begin(9600);
  EEPROM.get(16, cal);
  valid = memcmp(cal.magic, "BALL", 4) == 0;
  if (!valid) {
    Serial.println(F("not calibrated"));
    return;
  }
  byte boots = EEPROM.read(0);
  EEPROM.update(0, boots + 1);
  Serial.print("start number ");
  Serial.println(EEPROM.read(0));
  servoX.attach(2);
  servoY.attach(3);
}

void loop() {
  if (!valid) return;
  float x = millimeters(analogRead(A4), cal.xMin, cal.xMax, 320);
  float y = millimeters(analogRead(A5), cal.yMin, cal.yMax, 240);
  float ux = -cal.kp * x - cal.kd * (x - lastX) / 0.015;
  float uy = -cal.kp * y - cal.kd * (y - lastY) / 0.015;
  lastX = x;
  lastY = y;
  servoX.writeMicroseconds(cal.levelX + (int)(10 * ux));
  servoY.writeMicroseconds(cal.levelY - (int)(10 * uy));
  delay(15);
}
