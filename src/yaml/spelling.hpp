// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// American and British spellings of one key: center and centre.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace bbsim::yaml {

// The same path of keys with its British words spelled the American way, and the other way round.
[[nodiscard]] std::string american(std::string_view path);
[[nodiscard]] std::string british(std::string_view path);

// The name in its other spelling, if it has two.
[[nodiscard]] std::optional<std::string> other_spelling(std::string_view name);

}  // namespace bbsim::yaml
