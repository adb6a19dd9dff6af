// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// TouchScreen.h: reads a resistive four-wire screen by driving its electrodes. A coordinate is 1023
// minus the reading, as in Adafruit's library.
#pragma once

#include "Arduino.h"

class TSPoint {
 public:
  TSPoint(int16_t at_x = 0, int16_t at_y = 0, int16_t pressure = 0)
      : x(at_x), y(at_y), z(pressure) {}
  bool operator==(const TSPoint& other) const {
    return x == other.x && y == other.y && z == other.z;
  }
  bool operator!=(const TSPoint& other) const { return !(*this == other); }
  int16_t x, y, z;
};

class TouchScreen {
 public:
  TouchScreen(int x_plus, int y_plus, int x_minus, int y_minus, uint16_t x_resistance = 0)
      : xp_(x_plus), yp_(y_plus), xm_(x_minus), ym_(y_minus), resistance_(x_resistance) {}

  int readTouchX() { return 1023 - along(xp_, xm_, yp_, ym_, yp_); }
  int readTouchY() { return 1023 - along(yp_, ym_, xp_, xm_, xm_); }
  bool isTouching() { return pressure() > pressureThreshhold; }

  uint16_t pressure() {
    float z = 0;
    const int x = resistance_ == 0 ? 0 : readTouchX();
    pinMode(xp_, OUTPUT);
    digitalWrite(xp_, LOW);
    pinMode(ym_, OUTPUT);
    digitalWrite(ym_, HIGH);
    pinMode(xm_, INPUT);
    pinMode(yp_, INPUT);
    const int z1 = analogRead(xm_), z2 = analogRead(yp_);
    if (resistance_ == 0) return static_cast<uint16_t>(1023 - (z2 - z1));
    if (z1 == 0) return 0;
    z = (static_cast<float>(z2) / z1 - 1) * x * resistance_ / 1024;
    return static_cast<uint16_t>(z);
  }

  TSPoint getPoint() {
    const int x = readTouchX(), y = readTouchY();
    return {static_cast<int16_t>(x), static_cast<int16_t>(y), static_cast<int16_t>(pressure())};
  }

  int16_t pressureThreshhold = 10;

 private:
  // Drives one plate and reads the other.
  static int along(int plus, int minus, int other_plus, int other_minus, int read) {
    bbsim_board::require_plate(plus, minus);
    pinMode(other_plus, INPUT);
    pinMode(other_minus, INPUT);
    pinMode(plus, OUTPUT);
    digitalWrite(plus, HIGH);
    pinMode(minus, OUTPUT);
    digitalWrite(minus, LOW);
    delayMicroseconds(20);
    return (analogRead(read) + analogRead(read)) >> 1;
  }

  int xp_, yp_, xm_, ym_;
  uint16_t resistance_;
};
