// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Man pages, made from the texts of the commands: bbsim.1, and one for each command.
#pragma once

#include <functional>
#include <string>

#include "command.hpp"
#include "command_texts.hpp"

namespace bbsim::app {

// Page of the program, bbsim.1, or of a command, such as bbsim-run.1.
[[nodiscard]] std::string man_page(const ProgramText& texts);
[[nodiscard]] std::string man_page(const CommandText& command, const ProgramText& texts);

void add_man(Command& command, const std::function<ProgramText()>& texts);

}  // namespace bbsim::app
