// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads "x,y" lines from a camera at 30 frames per second on Serial1; pixels of a 640 x 480 image.
#include <Servo.h>

Servo sx;
Servo sy;

String line = "";
bool haveFrame = false;

float px, py;          // pixels
float vx = 0, vy = 0;  // pixels per second, smoothed
unsigned long lastFrame = 0;

const float KP = 0.022, KD = 0.016;  // degrees per pixel

void setup() {
  Serial.begin(115200);
  Serial1.begin(115200);
  sx.attach(9);
  sy.attach(10);
  sx.write(90);
  sy.write(90);
  line.reserve(32);
  Serial.println(F("waiting for camera"));
}

void loop() {
  while (Serial1.available() > 0) {
    char c = Serial1.read();
    if (c == '\n') {
      handleLine();
      line = "";
    } else if (c != '\r') {
      line += c;
    }
  }
  if (haveFrame) {
    haveFrame = false;
    control();
  }
}

void handleLine() {
  int comma = line.indexOf(',');
  if (comma < 0) return;
  float nx = line.substring(0, comma).toFloat();
  float ny = line.substring(comma + 1).toFloat();
  if (nx < 0 || ny < 0) return;  // ball not found
  unsigned long now = millis();
  if (lastFrame != 0) {
    float dt = (now - lastFrame) / 1000.0;
    vx = 0.4 * vx + 0.6 * (nx - px) / dt;
    vy = 0.4 * vy + 0.6 * (ny - py) / dt;
  }
  lastFrame = now;
  px = nx;
  py = ny;
  haveFrame = true;
}

void control() {
  float ax = KP * (320 - px) - KD * vx;
  float ay = KP * (240 - py) - KD * vy;
  sx.writeMicroseconds(angleToPulse(ax));
  sy.writeMicroseconds(angleToPulse(-ay));
}

int angleToPulse(float degrees_) {
  degrees_ = constrain(degrees_, -10, 10);
  return 1472 + round(degrees_ * 10.31);
}
