// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Words of a command that a shell reads.
#pragma once

#include <string>
#include <string_view>

namespace bbsim {

// The text as one word, in single quotes if it needs them.
[[nodiscard]] std::string shell_word(std::string_view text);

}  // namespace bbsim
