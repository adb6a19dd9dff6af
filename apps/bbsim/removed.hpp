// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Options, commands and endings that earlier versions had, with what to use instead
// (docs/how-to/migrate.md).
#pragma once

#include <string>
#include <string_view>

namespace bbsim::app {

// A sentence about the removed option ("--until"), command ("man") or ending (".glb"); empty if no
// version had it.
[[nodiscard]] std::string removed_option(std::string_view option);
[[nodiscard]] std::string removed_command(std::string_view command);
[[nodiscard]] std::string removed_ending(std::string_view ending);

}  // namespace bbsim::app
