// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Servo.h, as on the boards: values from 544 on are microseconds. 90 degrees are 1472 us and a
// degree is 10.3 us, unless attach() sets other limits.
#pragma once

#include "Arduino.h"

#define MIN_PULSE_WIDTH 544
#define MAX_PULSE_WIDTH 2400
#define DEFAULT_PULSE_WIDTH 1500
#define INVALID_SERVO 255

class Servo {
 public:
  uint8_t attach(int pin, int min = MIN_PULSE_WIDTH, int max = MAX_PULSE_WIDTH);
  void detach();
  void write(int value);
  void writeMicroseconds(int us);
  int read() const;
  int readMicroseconds() const { return us_; }
  bool attached() const { return pin_ >= 0; }

 private:
  int least() const { return MIN_PULSE_WIDTH - 4 * min_; }
  int most() const { return MAX_PULSE_WIDTH - 4 * max_; }
  void send();

  int pin_ = -1, axis_ = -1;
  int us_ = DEFAULT_PULSE_WIDTH;
  int8_t min_ = 0, max_ = 0;
};
