// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Names as users write them: in American and British spelling (center, centre), abbreviated, or
// with typing errors ("did you mean ...?").
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace bbsim::yaml {

// The path with all words in American spelling, or in British spelling.
[[nodiscard]] std::string american(std::string_view path);
[[nodiscard]] std::string british(std::string_view path);

// The name in its other spelling, if it has one.
[[nodiscard]] std::optional<std::string> other_spelling(std::string_view name);

// The name that `word` most likely means: the one that it abbreviates, or the one with the fewest
// typing errors. An error is a letter missing, added, changed, or swapped with its neighbor; case
// does not count. Empty if every name has more than one error per three letters.
[[nodiscard]] std::string_view nearest_name(std::string_view word,
                                            std::span<const std::string_view> names);

// " (did you mean NAME?)" for the nearest name; empty if there is none or if it is the word.
[[nodiscard]] std::string hint(std::string_view word, std::span<const std::string_view> names);

// The key that `word` may mean: one of `known`, the keys of the mapping, or a path from the top of
// the scenario if none of them fits. Empty for an unknown word.
[[nodiscard]] std::string_view synonym(std::string_view word,
                                       std::span<const std::string_view> known);

}  // namespace bbsim::yaml
