// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Completion for bash, zsh and fish: scripts made from the texts of the commands, so that they
// match --help.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "command.hpp"
#include "command_texts.hpp"

namespace bbsim::app {

// `shell` is bash, zsh or fish.
[[nodiscard]] std::string completion_script(std::string_view shell, const ProgramText& texts);

void add_completion(Command& command, const std::function<ProgramText()>& texts);

}  // namespace bbsim::app
