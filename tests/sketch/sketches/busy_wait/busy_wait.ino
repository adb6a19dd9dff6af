// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

/*
   PD control of a ball, everything by hand.
   touch:  X+ A0   X- A2   Y+ A1   Y- A3
   servos: roll 3  pitch 11
*/
#include <Servo.h>

const byte XPLUS = A0, XMINUS = A2, YPLUS = A1, YMINUS = A3;
#define SAMPLES 5
#define DT 20  // ms

Servo roll, pitch;
float x0, y0, x1, y1;  // last and present position, cm
float P = 0.7, D = 0.5;
unsigned long t;

int readX() {
  pinMode(XPLUS, OUTPUT);
  pinMode(XMINUS, OUTPUT);
  pinMode(YPLUS, INPUT);
  pinMode(YMINUS, INPUT);
  digitalWrite(XPLUS, HIGH);
  digitalWrite(XMINUS, LOW);
  delay(1);
  long sum = 0;
  for (int i = 0; i < SAMPLES; i++) sum += analogRead(YPLUS);
  return sum / SAMPLES;
}

int readY() {
  pinMode(YPLUS, OUTPUT);
  pinMode(YMINUS, OUTPUT);
  pinMode(XPLUS, INPUT);
  pinMode(XMINUS, INPUT);
  digitalWrite(YPLUS, HIGH);
  digitalWrite(YMINUS, LOW);
  delay(1);
  long sum = 0;
  for (int i = 0; i < SAMPLES; i++) sum += analogRead(XPLUS);
  return sum / SAMPLES;
}

void setup() {
  Serial.begin(115200);
  roll.attach(3, 600, 2400);
  pitch.attach(11, 600, 2400);
  roll.write(1500);
  pitch.write(1500);
  x0 = (readX() - 512) * 0.04;
  y0 = (readY() - 512) * 0.04;
  t = millis();
}

void loop() {
  x1 = (readX() - 512) * 0.04;
  y1 = (readY() - 512) * 0.04;
  float u = -P * x1 - D * (x1 - x0) / (DT / 1000.0);  // degrees
  float v = -P * y1 - D * (y1 - y0) / (DT / 1000.0);
  u = constrain(u, -15, 15);
  v = constrain(v, -15, 15);
  roll.writeMicroseconds(1500 + u * 10);
  pitch.writeMicroseconds(1500 - v * 10);
  x0 = x1;
  y0 = y1;
  Serial.print(x1);
  Serial.print('\t');
  Serial.println(y1);
  while (millis() - t < DT)
    ;  // wait
  t += DT;
}
