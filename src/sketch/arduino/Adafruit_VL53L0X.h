// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Adafruit_VL53L0X.h: the same sensor by Adafruit's library.
#pragma once

#include "VL53L0X.h"

#define VL53L0X_I2C_ADDR 0x29

struct VL53L0X_RangingMeasurementData_t {
  uint16_t RangeMilliMeter;
  uint8_t RangeStatus;  // 0: valid; 4: out of range
};

class Adafruit_VL53L0X {
 public:
  bool begin(uint8_t = VL53L0X_I2C_ADDR, bool = false, TwoWire* = &Wire) { return chip_.init(); }
  bool setMeasurementTimingBudgetMicroSeconds(uint32_t us) {
    return chip_.setMeasurementTimingBudget(us);
  }
  void rangingTest(VL53L0X_RangingMeasurementData_t* into, bool = false) {
    into->RangeMilliMeter = chip_.readRangeSingleMillimeters();
    into->RangeStatus = into->RangeMilliMeter >= 8190 ? 4 : 0;
    status_ = into->RangeStatus;
  }
  void getSingleRangingMeasurement(VL53L0X_RangingMeasurementData_t* into, bool = false) {
    rangingTest(into);
  }
  uint16_t readRange() {
    VL53L0X_RangingMeasurementData_t now;
    rangingTest(&now);
    return now.RangeMilliMeter;
  }
  uint8_t readRangeStatus() const { return status_; }
  bool startRangeContinuous(uint16_t period_ms = 50) {
    chip_.startContinuous(period_ms);
    return true;
  }
  void stopRangeContinuous() {}
  bool isRangeComplete() { return true; }
  uint16_t readRangeResult() { return chip_.readRangeContinuousMillimeters(); }

 private:
  VL53L0X chip_;
  uint8_t status_ = 0;
};
