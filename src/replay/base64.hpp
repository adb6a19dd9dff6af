// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Writes numbers as text that a page can decode: base64 of their little-endian bytes.
#pragma once

#include <span>
#include <string>

namespace bbsim::replay {

[[nodiscard]] std::string base64(std::span<const unsigned char> bytes);

// Values beyond the range of a float become infinite.
[[nodiscard]] std::string base64_of_floats(std::span<const double> values);
[[nodiscard]] std::string base64_of_doubles(std::span<const double> values);

// Values from -1 to 1, in steps of 1/32767.
[[nodiscard]] std::string base64_of_parts(std::span<const double> values);

// The nearest float; infinite on overflow, where a plain conversion is undefined.
[[nodiscard]] float to_float(double value);

}  // namespace bbsim::replay
