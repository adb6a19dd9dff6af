// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#if ARDUINO >= 100
#include "Arduino.h"
#else
#include "WProgram.h"
#endif

#include <PID_v1.h>

PID::PID(double* Input, double* Output, double* Setpoint, double Kp, double Ki, double Kd,
         int direction)
    : kp(Kp),
      ki(Ki),
      kd(Kd),
      input(Input),
      output(Output),
      setpoint(Setpoint),
      lastTime(millis()),
      sum(0),
      lastInput(0),
      period(0.1),
      low(0),
      high(255),
      inAuto(false) {
  if (direction == REVERSE) {
    kp = -kp;
    ki = -ki;
    kd = -kd;
  }
}

void PID::SetMode(int mode) {
  if (mode == AUTOMATIC && !inAuto) {
    sum = limited(*output);
    lastInput = *input;
  }
  inAuto = mode == AUTOMATIC;
}

bool PID::Compute() {
  unsigned long now = millis();
  if (!inAuto || now - lastTime < period * 1000) return false;
  double error = *setpoint - *input;
  sum = limited(sum + ki * period * error);
  *output = limited(kp * error + sum - kd * (*input - lastInput) / period);
  lastInput = *input;
  lastTime = now;
  return true;
}

void PID::SetOutputLimits(double Min, double Max) {
  low = Min;
  high = Max;
}

void PID::SetSampleTime(int ms) {
  period = ms / 1000.0;
}
