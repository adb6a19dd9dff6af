// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Keys, their meaning and their allowed values, as the readers of a scenario declare them. They are
// the source of the tables of the documents, the JSON Schema and completion.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "yaml/quantity.hpp"

namespace bbsim::yaml {

// Bounds in SI units. Empty bounds do not apply.
struct Range {
  std::optional<double> above{};
  std::optional<double> at_least{};
  std::optional<double> at_most{};

  [[nodiscard]] bool holds(double value) const;
  [[nodiscard]] std::string text() const;  // " greater than 0"; empty without bounds
};

// Groups of keys of a mapping. The keys of a group exclude those of the other groups.
struct Choice {
  std::vector<std::vector<std::string_view>> groups;
  bool needed = false;  // one of the groups must be present
};

// What the documents say of a key, in Markdown. The declaration fills empty cells of unit, default
// and range; "-" is an empty cell.
struct About {
  std::string_view meaning{};
  std::string_view unit{}, standard{}, range{};
};
// The same as of the key declared before.
inline constexpr About same{"="};

struct DeclaredKey;

// The values that a key takes.
struct Declared {
  enum class Kind {
    none,     // nothing was declared
    number,   // of a dimension, in a range
    text,     // any text
    name,     // one of `names`
    unit,     // the name of a unit of the dimension
    list,     // `fewest` to `most` items, each like the first of `parts`
    mapping,  // of `keys`
    names,    // a mapping of any names to values like the first of `parts`
    any,      // like any of `parts`
  };
  static constexpr std::size_t unbounded = std::numeric_limits<std::size_t>::max();

  Kind kind;
  Dimension dimension = Dimension::number;
  Range range{};
  bool whole = false;  // a number without a fraction
  std::vector<std::string> names{};
  std::vector<Declared> parts{};
  std::size_t fewest = 1, most = unbounded;
  bool distinct = false;  // no item occurs twice
  std::vector<DeclaredKey> keys;
  std::vector<Choice> choices{};
  std::vector<std::vector<std::vector<std::string_view>>> needs{};  // all keys of one of the groups
  std::vector<std::pair<std::string_view, std::string_view>>
      together{};            // the first needs the other
  std::string definition{};  // the name of a value that the schema defines once

  Declared(Kind of = Kind::none);  // NOLINT: a kind alone is a declaration
  [[nodiscard]] static Declared number(Dimension dimension, Range range = {});
  [[nodiscard]] static Declared list(std::size_t fewest, std::size_t most, Declared item);
  [[nodiscard]] static Declared any(std::vector<Declared> parts);

  // Whether some key of this mapping must be given.
  [[nodiscard]] bool needs_keys() const;
  // The choice that the key belongs to; nullptr if there is none.
  [[nodiscard]] const Choice* choice_of(std::string_view key) const;
};

struct DeclaredKey {
  std::string name;  // in American spelling
  Declared value;
  bool required = false;
  std::string standard{};  // default as text; empty if it has no text
  bool section = false;    // a mapping that reads like an empty one if it is missing
  About about{};

  [[nodiscard]] bool must_be_given() const { return required || (section && value.needs_keys()); }
};

inline Declared::Declared(Kind of) : kind(of) {}

}  // namespace bbsim::yaml
