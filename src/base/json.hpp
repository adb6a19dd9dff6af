// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// JSON as text. Its parser and writer cost compilers seconds, so they are compiled here only.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace bbsim {

using Json = nlohmann::ordered_json;

// The deepest nesting that is accepted. Comparing, copying and writing a value recurse.
inline constexpr std::size_t deepest_json = 100;

// The value of the text. If the text is not JSON or nests deeper than deepest_json, the result is
// discarded: is_discarded() is true, and no other use is allowed. All JSON from outside goes
// through this function.
[[nodiscard]] Json parse_json(std::string_view text);

// Without line breaks if `indent` is negative. Replaces bytes that are not UTF-8: file names need
// not be, but JSON must.
[[nodiscard]] std::string json_text(const Json& json, int indent = -1);

}  // namespace bbsim
