// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Numbers as text for people to read.
#pragma once

#include <string>

namespace bbsim {

// The number with up to six significant digits.
[[nodiscard]] std::string short_number(double value);

// The number with `digits` digits; from 1 to 1e15 without an exponent: 12.3, 1230000.
[[nodiscard]] std::string rounded(double value, int digits);

}  // namespace bbsim
