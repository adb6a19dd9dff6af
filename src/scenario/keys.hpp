// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// All keys of a scenario. The readers (sections.hpp) declare each key with its dimension, range and
// default; the tables here add what no reader knows: the meaning, and units without a dimension.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "yaml/declared.hpp"

namespace bbsim::scenario {

// The keys of a row and their documentation. The declaration fills cells for unit, default and
// range that are empty here; "-" is an empty cell.
struct KeyText {
  std::string_view keys;  // "ball.push.x .y": a key, and others that differ in the last name
  std::string_view meaning;
  std::string_view unit{}, standard{}, range{};

  // The keys with their full paths.
  [[nodiscard]] std::vector<std::string> paths(std::string_view prefix) const;
};

// A table of a page of docs/reference.
struct KeyTable {
  std::string_view page, heading;
  std::string_view prefix;  // of all keys except those at the top level
  std::span<const KeyText> rows;
};
[[nodiscard]] std::span<const KeyTable> key_tables();

// The declaration of the whole scenario.
[[nodiscard]] const yaml::Declared& declared_keys();

// The path of a key in the tables. Some keys share rows, such as those of profiles.
[[nodiscard]] std::string path_in_tables(std::string_view path);

// The row of a key with this path in the tables; nullptr if there is none.
[[nodiscard]] const KeyText* text_of_key(std::string_view path);

}  // namespace bbsim::scenario
