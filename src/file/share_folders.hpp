// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Where the files are that come with the program, beside it.
#pragma once

#include <string>
#include <vector>

namespace bbsim::file {

// The folders that share/bbsim may be, in order; BBSIM_SHARE_PATH alone, if it is set.
[[nodiscard]] std::vector<std::string> share_folders();

}  // namespace bbsim::file
