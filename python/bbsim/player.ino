// Plays a motion of the plate that `bbsim design` has chosen, and prints a log of it for
// `bbsim fit`. The motion begins after WAIT, with the ball at rest at
// x = @X@ cm, y = @Y@ cm.
//
// Set the constants for your rig: pins, pulses, and the scale of the touch screen.
#include <Servo.h>
#include <avr/pgmspace.h>

const int PIN_PHI = 9, PIN_THETA = 10;                  // of the servos
const float LEVEL_PHI = 1500, LEVEL_THETA = 1500;       // us: the pulse at which the plate is level
const float US_PER_DEG_PHI = 10, US_PER_DEG_THETA = 10; // negative if the servo turns the other way
const int PIN_X = A0, PIN_Y = A1;                       // of the touch screen
const float MIDDLE_X = 512, MIDDLE_Y = 512;             // counts at the center of the plate
const float MM_PER_COUNT_X = 0.32, MM_PER_COUNT_Y = 0.32;
const unsigned long WAIT = 5000;                        // ms

const unsigned long PERIOD = @PERIOD@;  // us
const unsigned int ROWS = @ROWS@;
const float DEG_PER_UNIT = @UNIT@;
const int16_t TABLE[ROWS][2] PROGMEM = {  // phi, theta
@TABLE@
};

Servo servoPhi, servoTheta;
unsigned long start;     // us
unsigned int row = 0;

float angleOf(unsigned int i, byte axis) {
  return (int16_t)pgm_read_word(&TABLE[i][axis]) * DEG_PER_UNIT;
}

void tilt(float phi, float theta) {
  servoPhi.writeMicroseconds(lround(LEVEL_PHI + phi * US_PER_DEG_PHI));
  servoTheta.writeMicroseconds(lround(LEVEL_THETA + theta * US_PER_DEG_THETA));
}

void setup() {
  Serial.begin(115200);
  servoPhi.attach(PIN_PHI);
  servoTheta.attach(PIN_THETA);
  tilt(angleOf(0, 0), angleOf(0, 1));
  delay(WAIT);
  Serial.println("t_ms,phi_deg,theta_deg,x_mm,y_mm");
  start = micros();
}

void loop() {
  if (row >= ROWS || micros() - start < row * PERIOD) return;
  const float phi = angleOf(row, 0), theta = angleOf(row, 1);
  tilt(phi, theta);
  const unsigned long now = micros() - start;
  const float x = (analogRead(PIN_X) - MIDDLE_X) * MM_PER_COUNT_X;
  const float y = (analogRead(PIN_Y) - MIDDLE_Y) * MM_PER_COUNT_Y;
  Serial.print(now / 1000.0, 1);
  Serial.print(',');
  Serial.print(phi, 3);
  Serial.print(',');
  Serial.print(theta, 3);
  Serial.print(',');
  Serial.print(x, 2);
  Serial.print(',');
  Serial.println(y, 2);
  ++row;
}
