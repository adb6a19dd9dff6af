// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once
#define A 0  // before Arduino.h, as published sketches number their legs
#define B 1
#define T 0.02
#include <Arduino.h>

struct Axis {
  byte pin;
  float position, speed;
  float unused;
};

extern const float KP, KD;
const unsigned long PERIOD = 20;
