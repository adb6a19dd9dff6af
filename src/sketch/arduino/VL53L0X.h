// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// VL53L0X.h: a time-of-flight distance sensor on I2C. Readings wait for the end of a measurement.
#pragma once

#include "Wire.h"

class VL53L0X {
 public:
  enum vcselPeriodType { VcselPeriodPreRange, VcselPeriodFinalRange };

  bool init(bool = true);
  void setBus(TwoWire*) {}
  void setAddress(uint8_t) {}
  uint8_t getAddress() const { return 0x29; }
  void setTimeout(uint16_t) {}
  uint16_t getTimeout() const { return 0; }
  bool timeoutOccurred() { return false; }
  bool setMeasurementTimingBudget(uint32_t us);
  uint32_t getMeasurementTimingBudget() const { return budget_us_; }
  bool setSignalRateLimit(float) { return true; }
  bool setVcselPulsePeriod(vcselPeriodType, uint8_t) { return true; }

  void startContinuous(uint32_t period_ms = 0);
  void stopContinuous() {}
  // mm; 8190 out of range
  uint16_t readRangeContinuousMillimeters();
  uint16_t readRangeSingleMillimeters();

 private:
  uint32_t budget_us_ = 33000, period_us_ = 33000;
  long long next_ = 0;  // end of the measurement that runs, ns
};
