// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Suggests names for "did you mean ...?".
#pragma once

#include <span>
#include <string_view>

namespace bbsim::yaml {

// The name that `word` most likely means: the one that it abbreviates, or the one with the fewest
// typing errors. An error is a letter missing, added, changed, or swapped with its neighbor; case
// does not count. Empty if every name has more than one error per three letters.
[[nodiscard]] std::string_view nearest_name(std::string_view word,
                                            std::span<const std::string_view> names);

// The key that `word` may mean: one of `known`, the keys of the mapping, or a path from the top of
// the scenario if none of them fits. Empty for an unknown word.
[[nodiscard]] std::string_view synonym(std::string_view word,
                                       std::span<const std::string_view> known);

}  // namespace bbsim::yaml
