// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// SoftwareSerial.h: a serial port on any two pins. Nothing is connected to it: what the sketch
// prints there is lost, and nothing arrives.
#pragma once

#include "Arduino.h"

class SoftwareSerial : public Stream {
 public:
  SoftwareSerial(int, int, bool = false) {}
  void begin(long) {}
  void end() {}
  bool listen() { return true; }
  bool isListening() { return true; }
  bool overflow() { return false; }
  int available() override { return 0; }
  int read() override { return -1; }
  int peek() override { return -1; }
  size_t write(uint8_t) override { return 1; }
  using Print::write;
  explicit operator bool() const { return true; }
};
