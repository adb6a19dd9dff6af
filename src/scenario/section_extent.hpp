// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Finds the extent of a mapping or a list in a scenario's text.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace bbsim::scenario {

struct Extent {
  std::size_t from, to;
};

// The extent of the {...} or [...] at `from`. Ignores brackets in quotes and comments.
[[nodiscard]] std::optional<Extent> flow_extent(std::string_view text, std::size_t from);

// The extent of the indented lines below the key at `key`, from the end of the key's line. Empty if
// anything but a comment follows the key on its line, such as an anchor.
[[nodiscard]] std::optional<Extent> block_extent(std::string_view text, std::size_t key);

}  // namespace bbsim::scenario
