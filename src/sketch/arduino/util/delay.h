// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Waiting loops of avr-libc.
#pragma once

#include "../Arduino.h"

inline void _delay_us(double us) {
  bbsim_board::spend(static_cast<long long>(us * 1e3));
}
inline void _delay_ms(double ms) {
  bbsim_board::spend(static_cast<long long>(ms * 1e6));
}
