// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// "Did you mean ...?"
#pragma once

#include <span>
#include <string_view>

namespace bbsim::yaml {

// The name that `word` most likely was meant to be: the one with the fewest typing errors (a letter
// missing, added, changed, or swapped with its neighbour; case aside), or the one that it
// abbreviates. Empty if none is near: more than one error in three letters.
[[nodiscard]] std::string_view nearest_name(std::string_view word,
                                            std::span<const std::string_view> names);

}  // namespace bbsim::yaml
