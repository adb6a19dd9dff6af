// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Printable is declared in HardwareSerial.h.
#pragma once

#include "Arduino.h"
