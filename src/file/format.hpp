// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The format of a file from its name.
#pragma once

#include <string>

namespace bbsim::file {

enum class Format { csv, hdf5, other };

// Decides by the ending, in upper or lower case: .csv, .h5, .hdf5.
[[nodiscard]] Format format_of(const std::string& file);

// The ending in lower case: ".svg" for "a.SVG".
[[nodiscard]] std::string lower_ending(const std::string& file);

}  // namespace bbsim::file
