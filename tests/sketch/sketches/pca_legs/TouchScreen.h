// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Stands for a copy of Adafruit's header, which needs the registers of an AVR.
#error "the board's own TouchScreen.h comes first"
