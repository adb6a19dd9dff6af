// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Numbers as text for people.
#pragma once

#include <string>

namespace bbsim {

// A number in the shortest form that a person reads with pleasure: up to six digits.
[[nodiscard]] std::string short_number(double value);

// A number to so many digits, without an exponent where it is 1 or more: 12.3, 1230000.
[[nodiscard]] std::string rounded(double value, int digits);

}  // namespace bbsim
