// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// American and British spellings of keys: center and centre.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace bbsim::yaml {

// The path with all words in American spelling, or in British spelling.
[[nodiscard]] std::string american(std::string_view path);
[[nodiscard]] std::string british(std::string_view path);

// The name in its other spelling, if it has one.
[[nodiscard]] std::optional<std::string> other_spelling(std::string_view name);

}  // namespace bbsim::yaml
