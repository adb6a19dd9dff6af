// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// LiquidCrystal.h: a display of characters. What the sketch prints there is lost, and takes no
// time.
#pragma once

#include "Arduino.h"

class LiquidCrystal : public Print {
 public:
  template <class... Pins>
  explicit LiquidCrystal(Pins...) {}
  void begin(int, int, int = 0) {}
  void clear() {}
  void home() {}
  void setCursor(int, int) {}
  void display() {}
  void noDisplay() {}
  void cursor() {}
  void noCursor() {}
  void blink() {}
  void noBlink() {}
  void autoscroll() {}
  void noAutoscroll() {}
  void leftToRight() {}
  void rightToLeft() {}
  void scrollDisplayLeft() {}
  void scrollDisplayRight() {}
  void createChar(int, const uint8_t*) {}
  size_t write(uint8_t) override { return 1; }
  using Print::write;
};
