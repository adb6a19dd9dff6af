// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The whole board as one source, which `bbsim sketch` compiles with each sketch.
#include "runtime/controller.cpp"
#include "runtime/copies.cpp"
#include "runtime/core.cpp"
#include "runtime/coroutine.cpp"
#include "runtime/distances.cpp"
#include "runtime/pins.cpp"
#include "runtime/screen.cpp"
#include "runtime/serial.cpp"
#include "runtime/servos.cpp"
#include "runtime/steppers.cpp"
#include "runtime/text.cpp"
