// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Which format a file's name asks for.
#pragma once

#include <string>

namespace bbsim::file {

enum class Format { csv, hdf5, other };

// The ending of the file's name tells, in capitals or not: .csv, .h5, .hdf5.
[[nodiscard]] Format format_of(const std::string& file);

// ".svg" of "a.SVG".
[[nodiscard]] std::string lower_ending(const std::string& file);

}  // namespace bbsim::file
