// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// sei() and cli() are in Arduino.h; there are no interrupts.
#pragma once

#include "../Arduino.h"
