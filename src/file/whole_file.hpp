// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The content of a file that somebody named, in one piece.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace bbsim::file {

// Reads a file, a pipe or a device to its end. One that does not begin with `start` is read no
// further than that shows; what was read of it is returned. Throws InputError, "cannot read FILE:
// why", for a folder, too, and for more than `most` bytes.
[[nodiscard]] std::string read_whole(const std::string& file, std::string_view start = {},
                                     std::size_t most = std::size_t{1} << 30U);

}  // namespace bbsim::file
