// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Numbers as text that a page reads at once: base64 of their bytes, little-endian.
#pragma once

#include <span>
#include <string>

namespace bbsim::replay {

[[nodiscard]] std::string base64(std::span<const unsigned char> bytes);

// Values beyond what a float holds become infinite.
[[nodiscard]] std::string base64_of_floats(std::span<const double> values);
[[nodiscard]] std::string base64_of_doubles(std::span<const double> values);

// The values are from -1 to 1, and are kept in steps of 1/32767.
[[nodiscard]] std::string base64_of_parts(std::span<const double> values);

// The nearest float; not an overflow, which is undefined, but an infinity.
[[nodiscard]] float to_float(double value);

}  // namespace bbsim::replay
