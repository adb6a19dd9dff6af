/* A controller for an Arduino, with a PID for each axis. It moves the ball of the example "step" to
 * its reference:
 *
 *     bbsim sketch controller.ino
 *     bbsim examples step
 *     bbsim run step.yaml --set controller.pid=null \
 *         --set "controller.library={file: controller.so, wiring: controller-wiring.yaml}"
 *
 * The file controller-wiring.yaml says what the pins are connected to. `bbsim check`, with the same
 * --set, says where its commands drive the ball. */
#include <Servo.h>

const float REFERENCE_X = 0.03, REFERENCE_Y = 0;  // m
const float KP = 0.7, KI = 0.35, KD = 0.6;        // rad/m, rad/(m s), rad s/m
const float FILTER = 0.04;                        // s, of the velocity
const float LIMIT = 0.2;                          // rad
const float METERS_PER_COUNT = 0.00032;           // of the touch screen, whose middle is at 512
const float MICROSECONDS_PER_RADIAN = 573;        // of a servo's pulse; level at 1500
const unsigned long PERIOD = 20;                  // ms

Servo servoPhi, servoTheta;
unsigned long nextSample = 0;
bool seenAny = false;

struct Axis {
  float last = 0, velocity = 0, integral = 0;
};
Axis x, y;

// The tilt, in rad, that drives the ball from its position to the reference, in m.
float command(Axis &axis, float position, float reference) {
  const float dt = PERIOD / 1000.0, error = reference - position;
  if (seenAny) {
    axis.velocity += dt / (FILTER + dt) * ((position - axis.last) / dt - axis.velocity);
  }
  axis.last = position;
  const float tilt = KP * error + axis.integral - KD * axis.velocity;
  if (abs(tilt) < LIMIT) axis.integral += KI * error * dt;  // else it would wind up
  return constrain(tilt, -LIMIT, LIMIT);
}

void setup() {
  servoPhi.attach(9);
  servoTheta.attach(10);
}

void loop() {
  if (millis() < nextSample) return;
  nextSample += PERIOD;
  const int countX = analogRead(A0), countY = analogRead(A1);
  if (countX == 0) return;  // nothing touches the screen: hold the servos
  // Positive phi drives the ball towards +x, positive theta towards -y.
  const float phi = command(x, (countX - 512) * METERS_PER_COUNT, REFERENCE_X);
  const float theta = -command(y, (countY - 512) * METERS_PER_COUNT, REFERENCE_Y);
  seenAny = true;
  servoPhi.writeMicroseconds(1500 + round(phi * MICROSECONDS_PER_RADIAN));
  servoTheta.writeMicroseconds(1500 + round(theta * MICROSECONDS_PER_RADIAN));
}
