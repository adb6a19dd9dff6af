// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A ball on a beam: an ultrasonic sensor at its end, and a display.
#include <LiquidCrystal_I2C.h>
#include <Servo.h>

#define TRIG 8
#define ECHO 7
LiquidCrystal_I2C lcd(0x27, 16, 2);
Servo servo;
float last = 20, rate = 0;

float distance() {  // cm
  digitalWrite(TRIG, LOW);
  delayMicroseconds(2);
  digitalWrite(TRIG, HIGH);
  delayMicroseconds(10);
  digitalWrite(TRIG, LOW);
  return pulseIn(ECHO, HIGH) * 0.0343 / 2;
}

void setup() {
  pinMode(TRIG, OUTPUT);
  pinMode(ECHO, INPUT);
  servo.attach(9);
  lcd.init();
  lcd.backlight();
  last = distance();
}

void loop() {
  float d = distance();
  rate += 0.4 * ((d - last) / 0.04 - rate);
  last = d;
  float angle = 0.6 * (20 - d) - 0.6 * rate;
  servo.write(90 + constrain(lround(angle), -12, 12));
  lcd.setCursor(0, 0);
  lcd.print(d);
  delay(38);
}
