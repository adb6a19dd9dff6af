// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "gains.h"

extern const float KP = 0.07, KD = 0.045;
