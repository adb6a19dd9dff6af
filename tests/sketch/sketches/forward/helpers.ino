// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

void measure(Axis &axis) {
  float position = (analogRead(axis.pin) - 512) * 0.32f;
  axis.speed = (position - axis.position) / (PERIOD / 1000.0f);
  axis.position = position;
}

float law(const Axis &axis,
          float kp, float kd) {
  return -kp * axis.position - kd * axis.speed;
}

int pulseFor(float angle, bool reversed = false) {
  float limited = constrain(angle, -12.0f, 12.0f);
  return 1500 + (reversed ? -1 : 1) * lround(10 * limited);
}
