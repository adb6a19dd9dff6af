// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Runs the program as it stands in a shell's line, with pipes and redirections; and on a terminal.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "process.hpp"

namespace bbsim_test {

// bash runs the line, in which $BBSIM is the program. Its exit code is that of the first process of
// the last pipe that failed, if one did.
Result shell(const std::string& line, const std::filesystem::path& folder);

// What the program sends to a terminal of that many columns until it ends, or until it is
// interrupted: after so many seconds, or when it has sent `awaited`, where that is something.
// `kind` is the terminal's, TERM; `typed` what a person types, from the start.
std::string on_terminal(const std::vector<std::string>& arguments, unsigned short columns,
                        const std::filesystem::path& folder, double seconds,
                        const std::string& awaited = "", const std::string& kind = "xterm",
                        const std::string& typed = "");

}  // namespace bbsim_test
