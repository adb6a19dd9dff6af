// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// For sketches that include it without need: this board has no registers.
#pragma once

#include "../Arduino.h"
