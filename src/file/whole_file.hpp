// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads a whole file.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace bbsim::file {

// Reads a file, a pipe or a device to its end. Stops early if the content does not begin with
// `start`, and returns the bytes read so far. Throws InputError, "cannot read FILE: why", also for
// a folder and for more than `most` bytes.
[[nodiscard]] std::string read_whole(const std::string& file, std::string_view start = {},
                                     std::size_t most = std::size_t{1} << 30U);

}  // namespace bbsim::file
