// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Applies overrides: --set key.path=value.
#pragma once

#include <string_view>

#include "yaml/document.hpp"

namespace bbsim::yaml {

// Returns the tree `root` with the value of `assignment` ("key.path=value", the value in YAML) set
// at the path. Replaces an existing value; otherwise creates it, with the mappings on the path.
// List items go by position from 0, without leading zeros; the position after the last item
// appends. The value null (not an empty value) removes the key or the list item; removing a missing
// key changes nothing. `root` stays unchanged and shares its unchanged nodes with the result.
// `source`, from 1, becomes the position of the new nodes. Throws TextFault.
[[nodiscard]] const Node* apply_override(std::string_view assignment, int source, const Node& root,
                                         Nodes& nodes);

// The same with path and value separate.
[[nodiscard]] const Node* apply_override(std::string_view path, std::string_view value, int source,
                                         const Node& root, Nodes& nodes);

}  // namespace bbsim::yaml
