// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A state machine: waits for the ball, brings it to the middle, then drives it around a square.
// 5-wire touch screen: all four corners are driven, one wire senses.
#include <Servo.h>

#define UL 22
#define UR 23
#define LL 24
#define LR 25
#define SENSE A0

enum State { WAITING, CENTERING, CORNERS };
State state = WAITING;

struct Point {
  float x, y;
};
const Point square[4] = {{50, 50}, {-50, 50}, {-50, -50}, {50, -50}};  // mm
int corner = 0;

Point ball, before, target = {0, 0};
float speedX, speedY;
float sumX = 0, sumY = 0;
unsigned long entered, tick;
Servo a, b;

bool touched() {
  digitalWrite(UL, LOW);
  digitalWrite(UR, LOW);
  digitalWrite(LL, LOW);
  digitalWrite(LR, LOW);
  pinMode(SENSE, INPUT_PULLUP);
  bool is = digitalRead(SENSE) == LOW;
  pinMode(SENSE, INPUT);
  return is;
}

float readX() {
  digitalWrite(UL, LOW);
  digitalWrite(LL, LOW);
  digitalWrite(UR, HIGH);
  digitalWrite(LR, HIGH);
  delayMicroseconds(200);
  return (analogRead(SENSE) - 511.5) * 0.4;
}

float readY() {
  digitalWrite(LL, LOW);
  digitalWrite(LR, LOW);
  digitalWrite(UL, HIGH);
  digitalWrite(UR, HIGH);
  delayMicroseconds(200);
  return (analogRead(SENSE) - 511.5) * 0.3;
}

void enter(State next) {
  state = next;
  entered = millis();
  Serial.print("state ");
  Serial.println(next);
}

void setup() {
  Serial.begin(115200);
  for (int pin = UL; pin <= LR; pin++) pinMode(pin, OUTPUT);
  a.attach(9);
  b.attach(10);
  a.write(90);
  b.write(90);
}

void control() {
  float ex = target.x - ball.x, ey = target.y - ball.y;
  sumX = constrain(sumX + ex * 0.02 * 0.01, -3, 3);
  sumY = constrain(sumY + ey * 0.02 * 0.01, -3, 3);
  float outX = 0.06 * ex - 0.042 * speedX + sumX;
  float outY = 0.06 * ey - 0.042 * speedY + sumY;
  a.writeMicroseconds(1472 + constrain(outX, -10, 10) * 10.31);
  b.writeMicroseconds(1472 - constrain(outY, -10, 10) * 10.31);
}

void loop() {
  if (millis() - tick < 20) return;
  tick = millis();
  if (!touched()) return;
  ball.x = readX();
  ball.y = readY();
  speedX = (ball.x - before.x) / 0.02;
  speedY = (ball.y - before.y) / 0.02;
  before = ball;

  switch (state) {
    case WAITING:
      enter(CENTERING);
      break;
    case CENTERING:
      target = {0, 0};
      control();
      if (sqrt(sq(ball.x) + sq(ball.y)) < 5 && millis() - entered > 1500) enter(CORNERS);
      break;
    case CORNERS:
      target = square[corner];
      control();
      if (millis() - entered > 3000) {
        corner = (corner + 1) % 4;
        entered = millis();
      }
      break;
  }
  Serial.print("target_x:");
  Serial.print(target.x);
  Serial.print(",target_y:");
  Serial.println(target.y);
}
