// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Where a mapping or a list stands in a scenario's text.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace bbsim::scenario {

struct Extent {
  std::size_t from, to;
};

// Of {...} or [...] that begins at `from`, quotes and comments within it heeded.
[[nodiscard]] std::optional<Extent> flow_extent(std::string_view text, std::size_t from);

// Of the indented lines below a key at `key`, from the end of the key's own line on. Nothing if
// more than a comment follows the key on that line, such as an anchor.
[[nodiscard]] std::optional<Extent> block_extent(std::string_view text, std::size_t key);

}  // namespace bbsim::scenario
