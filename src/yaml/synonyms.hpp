// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Names that users of other tools try first for keys: kd for kv, dt for time.step.
#pragma once

#include <span>
#include <string_view>

namespace bbsim::yaml {

// The key that `word` may mean: one of `known`, the keys of the mapping, or a path from the top of
// the scenario if none of them fits. Empty for an unknown word.
[[nodiscard]] std::string_view synonym(std::string_view word,
                                       std::span<const std::string_view> known);

}  // namespace bbsim::yaml
