// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Keys under the names that people from other tools try first: kd for kv, dt for time.step.
#pragma once

#include <span>
#include <string_view>

namespace bbsim::yaml {

// The key that `word` may stand for: one of `known`, the keys of the mapping, or a path from the
// top of the scenario if none of them fits. Empty if the word is no such name.
[[nodiscard]] std::string_view synonym(std::string_view word,
                                       std::span<const std::string_view> known);

}  // namespace bbsim::yaml
