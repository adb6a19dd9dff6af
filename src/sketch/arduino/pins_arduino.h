// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The pins are declared in Arduino.h.
#pragma once

#include "Arduino.h"
