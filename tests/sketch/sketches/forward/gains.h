// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once
#include <Arduino.h>

struct Axis {
  byte pin;
  float position, speed;
  float unused;
};

extern const float KP, KD;
const unsigned long PERIOD = 20;
