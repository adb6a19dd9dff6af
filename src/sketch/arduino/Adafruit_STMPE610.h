// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Adafruit_STMPE610.h: a chip that reads a resistive screen, in counts of 12 bits.
#pragma once

#include "SPI.h"
#include "Wire.h"

#define STMPE_ADDR 0x41
#define STMPE_INT_CTRL 0x09
#define STMPE_INT_EN 0x0A
#define STMPE_INT_STA 0x0B
#define STMPE_FIFO_TH 0x4A
#define STMPE_FIFO_STA 0x4B
#define STMPE_FIFO_STA_RESET 0x01

class TS_Point {
 public:
  TS_Point(int16_t at_x = 0, int16_t at_y = 0, int16_t pressure = 0)
      : x(at_x), y(at_y), z(pressure) {}
  bool operator==(const TS_Point& other) const {
    return x == other.x && y == other.y && z == other.z;
  }
  bool operator!=(const TS_Point& other) const { return !(*this == other); }
  int16_t x, y, z;
};

class Adafruit_STMPE610 {
 public:
  explicit Adafruit_STMPE610(int, SPIClass* = &SPI) {}  // its chip-select pin
  Adafruit_STMPE610(int, int, int, int) {}
  explicit Adafruit_STMPE610(TwoWire* = &Wire) : over_wire_(true) {}

  bool begin(uint8_t address = STMPE_ADDR);
  bool touched();
  bool bufferEmpty() { return bufferSize() == 0; }
  uint8_t bufferSize();
  void readData(uint16_t* x, uint16_t* y, uint8_t* z);
  TS_Point getPoint();

  BBSIM_LACKS(readRegister8, "Adafruit_STMPE610.readRegister8: the chip has no registers here")
  BBSIM_LACKS(readRegister16, "Adafruit_STMPE610.readRegister16: the chip has no registers here")
  // Only the reset of the buffer has an effect; sketches clear interrupts, of which there are none.
  void writeRegister8(uint8_t address, uint8_t value);

 private:
  void access(int registers) const;
  void require_chip() const;
  bool over_wire_ = false;
  long long read_ = 0;  // points up to this time have been read, ns
  TS_Point last_;
};
