// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Adafruit_GFX.h: what displays of pixels draw. All of it is lost, and takes no time.
#pragma once

#include "Arduino.h"

struct GFXfont;

class Adafruit_GFX : public Print {
 public:
  Adafruit_GFX(int16_t wide, int16_t high) : width_(wide), height_(high) {}
  int16_t width() const { return turned_ ? height_ : width_; }
  int16_t height() const { return turned_ ? width_ : height_; }
  void setRotation(uint8_t turns) { turned_ = turns % 2 != 0; }
  void setCursor(int16_t, int16_t) {}
  void setFont(const GFXfont* = nullptr) {}
  void setTextSize(uint8_t) {}
  void setTextSize(uint8_t, uint8_t) {}
  void setTextColor(uint16_t) {}
  void setTextColor(uint16_t, uint16_t) {}
  void setTextWrap(bool) {}
  void cp437(bool = true) {}
  void invertDisplay(bool) {}
  void fillScreen(uint16_t) {}
  virtual void drawPixel(int16_t, int16_t, uint16_t) {}
  void drawLine(int16_t, int16_t, int16_t, int16_t, uint16_t) {}
  void drawFastVLine(int16_t, int16_t, int16_t, uint16_t) {}
  void drawFastHLine(int16_t, int16_t, int16_t, uint16_t) {}
  void drawRect(int16_t, int16_t, int16_t, int16_t, uint16_t) {}
  void fillRect(int16_t, int16_t, int16_t, int16_t, uint16_t) {}
  void drawRoundRect(int16_t, int16_t, int16_t, int16_t, int16_t, uint16_t) {}
  void fillRoundRect(int16_t, int16_t, int16_t, int16_t, int16_t, uint16_t) {}
  void drawCircle(int16_t, int16_t, int16_t, uint16_t) {}
  void fillCircle(int16_t, int16_t, int16_t, uint16_t) {}
  void drawTriangle(int16_t, int16_t, int16_t, int16_t, int16_t, int16_t, uint16_t) {}
  void fillTriangle(int16_t, int16_t, int16_t, int16_t, int16_t, int16_t, uint16_t) {}
  void drawBitmap(int16_t, int16_t, const uint8_t*, int16_t, int16_t, uint16_t, uint16_t = 0) {}
  void drawChar(int16_t, int16_t, unsigned char, uint16_t, uint16_t, uint8_t) {}
  size_t write(uint8_t) override { return 1; }
  using Print::write;

 private:
  int16_t width_, height_;
  bool turned_ = false;
};
