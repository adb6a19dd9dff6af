// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The interface of the well-known library, as far as the sketches here use it.
#ifndef PID_v1_h
#define PID_v1_h

class PID {
 public:
#define AUTOMATIC 1
#define MANUAL 0
#define DIRECT 0
#define REVERSE 1
  PID(double *Input, double *Output, double *Setpoint, double Kp, double Ki, double Kd, int direction);
  void SetMode(int mode);
  bool Compute();
  void SetOutputLimits(double low, double high);
  void SetSampleTime(int ms);

 private:
  double limited(double value) const { return value > high ? high : value < low ? low : value; }
  double kp, ki, kd;
  double *input, *output, *setpoint;
  unsigned long lastTime;
  double sum, lastInput;
  double period;  // s
  double low, high;
  bool inAuto;
};

#endif
