// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// LiquidCrystal_I2C.h: the same display on the I2C bus.
#pragma once

#include "LiquidCrystal.h"
#include "Wire.h"

class LiquidCrystal_I2C : public LiquidCrystal {
 public:
  using LiquidCrystal::begin;
  using LiquidCrystal::LiquidCrystal;
  void begin() {}
  void init() {}
  void backlight() {}
  void noBacklight() {}
  void setBacklight(int) {}
};
