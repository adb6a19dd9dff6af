// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The I2C bus. Parts of the wiring that use it have their own headers; nothing else answers.
#pragma once

#include "Arduino.h"

class TwoWire {
 public:
  void begin() {}
  void end() {}
  void setClock(unsigned long rate) { rate_ = rate == 0 ? rate_ : rate; }
  long long clock_rate() const { return static_cast<long long>(rate_); }
  void setWireTimeout(unsigned long = 0, bool = false) {}

#define BBSIM_NOBODY                                                                         \
  "Wire: no part of the wiring speaks I2C by bytes; the parts that are there have headers: " \
  "Adafruit_STMPE610.h, Adafruit_PWMServoDriver.h, VL53L0X.h"
  BBSIM_LACKS(beginTransmission, BBSIM_NOBODY)
  BBSIM_LACKS(endTransmission, BBSIM_NOBODY)
  BBSIM_LACKS(requestFrom, BBSIM_NOBODY)
  BBSIM_LACKS(write, BBSIM_NOBODY)
  BBSIM_LACKS(available, BBSIM_NOBODY)
  BBSIM_LACKS(read, BBSIM_NOBODY)
  BBSIM_LACKS(onReceive, "Wire.onReceive: no other board asks this one")
  BBSIM_LACKS(onRequest, "Wire.onRequest: no other board asks this one")
#undef BBSIM_NOBODY

 private:
  unsigned long rate_ = 100000;  // Hz
};
inline TwoWire Wire, Wire1;
