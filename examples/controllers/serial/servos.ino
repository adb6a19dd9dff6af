/* SPDX-FileCopyrightText: 2026 the bbsim authors
 * SPDX-License-Identifier: BSD-3-Clause */

/* Turns two servos to the angles of a line "x,y" in degrees. It measures nothing: follow.py does, on the PC.
 *
 *     bbsim sketch examples/controllers/serial/servos.ino -o examples/controllers/serial/servos.so
 *     bbsim run examples/controllers/serial.yaml */
#include <Servo.h>

Servo phi, theta;

// Servo.write() takes whole degrees only.
void turn(Servo& servo, float degrees) {
  servo.writeMicroseconds(1472 + (int)((constrain(degrees, 75, 105) - 90) * 1856 / 180));
}

void setup() {
  Serial.begin(115200);
  Serial.setTimeout(10);
  phi.attach(9);
  theta.attach(10);
  Serial.println("ready");
}

void loop() {
  if (Serial.available() == 0) return;
  const String line = Serial.readStringUntil('\n');
  const int comma = line.indexOf(',');
  if (comma < 0) return;
  turn(phi, line.substring(0, comma).toFloat());
  turn(theta, line.substring(comma + 1).toFloat());
}
