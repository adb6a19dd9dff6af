/* SPDX-FileCopyrightText: 2026 the bbsim authors
 * SPDX-License-Identifier: BSD-3-Clause */

/* The PID of configs/step.yaml, written for a board: it runs unchanged on the rig and in bbsim.
 *
 *     bbsim sketch examples/controllers/arduino/pid.ino -o examples/controllers/arduino/pid.so
 *     bbsim run examples/controllers/arduino.yaml
 *
 * On boards with an 8-bit processor a double is a float, so it rounds more there than on a PC. */
#include <Servo.h>

const unsigned long period_ms = 20;
const double period = 0.02;         // s
const double filter = 0.04;         // time constant of the velocity's filter, s
const double count = 0.00032;       // of the touch screen, m
const double microsecond = 0.1 * 3.14159265358979323846 / 180;  // of a servo's pulse, rad
const double limit = 12 * 3.14159265358979323846 / 180;         // rad
const double kp = 0.7, kv = 0.6, ki = 0.35;

Servo phi, theta;

struct Axis {
  double reference = 0, position = 0, velocity = 0, integral = 0;
  bool seen_any = false;

  double law() const { return kp * (reference - position) + kv * (0 - velocity) + integral; }

  double command(double seen, double elapsed) {
    const double keep = filter / (filter + elapsed);
    velocity = keep * velocity + (1 - keep) * (seen_any ? (seen - position) / elapsed : 0);
    position = seen;
    seen_any = true;
    const double before = law(), error = reference - position;
    // The integral waits while the command is at its limit and the error drives it outward.
    if (!(fabs(before) >= limit && ki * error * before > 0)) integral += elapsed * (ki * error);
    const double u = law();
    return u > limit ? limit : u < -limit ? -limit : u;
  }
};

Axis x, y;
unsigned long next_sample = 0;
int periods = 1;  // since the last measured position

void setup() {
  Serial.begin(115200);
  phi.attach(9);
  theta.attach(10);
  x.reference = 0.03;
  Serial.println("PID is ready");
}

void loop() {
  if (millis() < next_sample) return;
  next_sample += period_ms;
  const int at_x = analogRead(A0), at_y = analogRead(A1);
  if (at_x == 0) {  // nothing touches the screen: hold the servos
    if (x.seen_any) ++periods;
    return;
  }
  const double elapsed = periods * period;
  // Positive phi drives the ball towards +x, positive theta towards -y.
  phi.writeMicroseconds(1500 + (int)lround(x.command((at_x - 512) * count, elapsed) / microsecond));
  theta.writeMicroseconds(1500 - (int)lround(y.command((at_y - 512) * count, elapsed) / microsecond));
  periods = 1;
}
