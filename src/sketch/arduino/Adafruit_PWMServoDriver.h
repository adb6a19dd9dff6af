// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Adafruit_PWMServoDriver.h: a PCA9685, which generates the pulses for servos.
#pragma once

#include "Wire.h"

class Adafruit_PWMServoDriver {
 public:
  explicit Adafruit_PWMServoDriver(uint8_t address = 0x40) : address_(address) {}
  Adafruit_PWMServoDriver(uint8_t address, TwoWire&) : address_(address) {}

  bool begin(uint8_t prescale = 0);
  void reset();
  void sleep() {}
  void wakeup() {}
  void setExtClk(uint8_t prescale) { prescale_ = prescale; }
  void setPWMFreq(float frequency);
  void setOutputMode(bool) {}
  uint8_t readPrescale();
  uint8_t setPWM(uint8_t channel, uint16_t on, uint16_t off);
  void setPin(uint8_t channel, uint16_t value, bool invert = false);
  void writeMicroseconds(uint8_t channel, uint16_t us);
  void setOscillatorFrequency(uint32_t frequency) { oscillator_ = frequency; }
  uint32_t getOscillatorFrequency() const { return static_cast<uint32_t>(oscillator_); }
  BBSIM_LACKS(getPWM, "Adafruit_PWMServoDriver.getPWM: keep what setPWM was given")

 private:
  uint8_t address_;
  uint8_t prescale_ = 30;
  double oscillator_ = 25e6;  // Hz, as the sketch assumes
};
