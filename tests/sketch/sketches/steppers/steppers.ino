// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// PD control with two stepper motors behind A4988 drivers, which the loop pulses by hand, and a
// touch controller with two analog outputs of 12 bits.
struct Motor {
  int step, dir;
  long at, target;
  unsigned long last;
};
Motor phi = {2, 3, 0, 0, 0}, theta = {4, 5, 0, 0, 0};
const int ENABLE = 8;

void run(Motor& m) {
  if (m.at == m.target || micros() - m.last < 400) return;
  m.last = micros();
  digitalWrite(m.dir, m.target > m.at ? HIGH : LOW);
  digitalWrite(m.step, HIGH);
  delayMicroseconds(2);
  digitalWrite(m.step, LOW);
  m.at += m.target > m.at ? 1 : -1;
}

float oldX, oldY, speedX, speedY;
unsigned long timer;

void setup() {
  for (int pin : {2, 3, 4, 5, ENABLE}) pinMode(pin, OUTPUT);
  digitalWrite(ENABLE, HIGH);
  digitalWrite(2, HIGH);  // a pulse that the driver ignores
  digitalWrite(2, LOW);
  digitalWrite(ENABLE, LOW);
  analogReadResolution(12);
}

void loop() {
  run(phi);
  run(theta);
  if (micros() - timer < 20000UL) return;
  timer += 20000UL;
  float x = (analogRead(A0) - 2048) * 0.01;  // cm
  float y = (analogRead(A1) - 2048) * 0.01;
  speedX += 0.3 * ((x - oldX) / 0.02 - speedX);
  speedY += 0.3 * ((y - oldY) / 0.02 - speedY);
  float u = -0.6 * x - 0.4 * speedX;  // degrees
  float v = -0.6 * y - 0.4 * speedY;
  oldX = x;
  oldY = y;
  phi.target = constrain(u, -12, 12) * 3200 / 360;
  theta.target = -constrain(v, -12, 12) * 3200 / 360;
}
