// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Adafruit_SSD1306.h: a small display of pixels.
#pragma once

#include "Adafruit_GFX.h"
#include "SPI.h"
#include "Wire.h"

enum { SSD1306_BLACK = 0, SSD1306_WHITE = 1, SSD1306_INVERSE = 2 };
enum { SSD1306_EXTERNALVCC = 1, SSD1306_SWITCHCAPVCC = 2 };
#define BLACK SSD1306_BLACK
#define WHITE SSD1306_WHITE
#define INVERSE SSD1306_INVERSE

class Adafruit_SSD1306 : public Adafruit_GFX {
 public:
  template <class... Connections>
  Adafruit_SSD1306(uint8_t wide, uint8_t high, Connections...) : Adafruit_GFX(wide, high) {}
  explicit Adafruit_SSD1306(int8_t = -1) : Adafruit_GFX(128, 64) {}
  bool begin(uint8_t = SSD1306_SWITCHCAPVCC, uint8_t = 0, bool = true, bool = true) { return true; }
  void display() {}
  void clearDisplay() {}
  void dim(bool) {}
  void ssd1306_command(uint8_t) {}
  void startscrollleft(uint8_t, uint8_t) {}
  void startscrollright(uint8_t, uint8_t) {}
  void stopscroll() {}
};
