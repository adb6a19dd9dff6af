// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Numbers without a fraction, from options, scenarios and callers of the API.
#pragma once

#include <string>

namespace bbsim {

// 2^53: doubles hold all whole numbers up to it.
inline constexpr double largest_whole = 9007199254740992.0;

// Also false for NaN.
[[nodiscard]] bool is_whole(double value, double least, double most = largest_whole);

// "a whole number from 1 up", "a whole number from 1 to 1024"
[[nodiscard]] std::string whole_numbers(double least, double most = largest_whole);

// Throws InputError with the name of the number.
void require_whole(const std::string& name, double value, double least,
                   double most = largest_whole);

}  // namespace bbsim
