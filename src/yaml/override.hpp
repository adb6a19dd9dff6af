// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// --set key.path=value
#pragma once

#include <string_view>

#include "yaml/document.hpp"

namespace bbsim::yaml {

// The tree under `root` with the value of `assignment` ("key.path=value", the value in YAML) at
// its path: replaced if it was there, created (with mappings on the way) if not. A list's items go
// by their position from 0, without zeros before it, and the position after the last appends. A
// value of null (not an empty one) removes the key, if it is there, or the item. The old tree stays
// as it is, and shares what did not change. `source`, from 1, is where the new nodes
// say they stand. Throws TextFault.
[[nodiscard]] const Node* apply_override(std::string_view assignment, int source, const Node& root,
                                         Nodes& nodes);

// Applies an override whose key's path and value are given apart.
[[nodiscard]] const Node* apply_override(std::string_view path, std::string_view value, int source,
                                         const Node& root, Nodes& nodes);

}  // namespace bbsim::yaml
