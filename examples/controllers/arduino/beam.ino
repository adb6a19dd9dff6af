/* SPDX-FileCopyrightText: 2026 the bbsim authors
 * SPDX-License-Identifier: BSD-3-Clause */

/* A ball on a beam: an ultrasonic sensor HC-SR04 at its low end, and a servo that lifts it by a push rod.
 *
 *     bbsim sketch examples/controllers/arduino/beam.ino -o examples/controllers/arduino/beam.so
 *     bbsim run examples/controllers/arduino-beam.yaml */
#include <Servo.h>

const int trigger = 8, echo = 7;
const float setpoint = 20;                    // cm
const float kp = 2.5, ki = 0.1, kd = 1.6;     // degrees of the servo per cm, cm s and cm/s

Servo servo;
float integral = 0, last_error = 0;
unsigned long last = 0;

float distance() {
  digitalWrite(trigger, LOW);
  delayMicroseconds(2);
  digitalWrite(trigger, HIGH);
  delayMicroseconds(10);
  digitalWrite(trigger, LOW);
  return pulseIn(echo, HIGH, 30000) * 0.0343 / 2;  // cm; 0 without an echo
}

void setup() {
  pinMode(trigger, OUTPUT);
  pinMode(echo, INPUT);
  servo.attach(9);
  servo.write(90);
  last = millis();
}

void loop() {
  const unsigned long now = millis();
  if (now - last < 50) return;
  const float seen = distance();
  const float elapsed = (now - last) / 1000.0;
  last = now;
  if (seen == 0) return;
  const float error = setpoint - seen;
  integral += error * elapsed;
  const float rate = (error - last_error) / elapsed;
  last_error = error;
  servo.write(90 + constrain(kp * error + ki * integral + kd * rate, -50, 50));
}
