// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The SPI bus. Parts of the wiring that use it have their own headers.
#pragma once

#include "Arduino.h"

enum { SPI_MODE0 = 0, SPI_MODE1 = 4, SPI_MODE2 = 8, SPI_MODE3 = 12 };

struct SPISettings {
  SPISettings() = default;
  SPISettings(unsigned long, int, int) {}
};

class SPIClass {
 public:
  void begin() {}
  void end() {}
  void beginTransaction(SPISettings) {}
  void endTransaction() {}
  void setClockDivider(int) {}
  void setBitOrder(int) {}
  void setDataMode(int) {}

#define BBSIM_NOBODY                                                                     \
  "SPI: no part of the wiring speaks SPI by bytes; the one that is there has a header: " \
  "Adafruit_STMPE610.h"
  BBSIM_LACKS(transfer, BBSIM_NOBODY)
  BBSIM_LACKS(transfer16, BBSIM_NOBODY)
#undef BBSIM_NOBODY
};
inline SPIClass SPI;
