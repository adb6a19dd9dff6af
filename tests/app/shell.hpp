// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Runs the program from a shell line, with pipes and redirections, or on a terminal.
#pragma once

#include <string>

#include "process.hpp"

namespace bbsim_test {

// Runs a line in bash, with the program as $BBSIM. The exit code is that of the first process that
// failed in the last pipe, or 0.
Result shell(const std::string& line, const Folder& folder);

// Returns what the program sends to a terminal of the given width until it ends or is interrupted:
// after the given seconds or, if `awaited` is not empty, once it has sent that. `kind` is the
// terminal type, TERM; `typed` is the input, sent at the start.
std::string on_terminal(const std::string& command, unsigned short columns, const Folder& folder,
                        double seconds, const std::string& awaited = "",
                        const std::string& kind = "xterm", const std::string& typed = "");

}  // namespace bbsim_test
