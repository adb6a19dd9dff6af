// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "yaml/declared.hpp"

#include <algorithm>

#include "base/number_text.hpp"

namespace bbsim::yaml {

bool Range::holds(double value) const {
  return (!above || value > *above) && (!at_least || value >= *at_least) &&
         (!at_most || value <= *at_most);
}

std::string Range::text() const {
  if (above && at_most) {
    return " greater than " + number_text(*above) + " and at most " + number_text(*at_most);
  }
  if (at_least && at_most)
    return " from " + number_text(*at_least) + " to " + number_text(*at_most);
  if (above) return " greater than " + number_text(*above);
  if (at_least) return " of at least " + number_text(*at_least);
  if (at_most) return " of at most " + number_text(*at_most);
  return "";
}

Declared Declared::number(Dimension dimension, Range range) {
  Declared value(Kind::number);
  value.dimension = dimension;
  value.range = range;
  return value;
}

Declared Declared::list(std::size_t fewest, std::size_t most, Declared item) {
  Declared value(Kind::list);
  value.fewest = fewest;
  value.most = most;
  value.parts.push_back(std::move(item));
  return value;
}

Declared Declared::any(std::vector<Declared> parts) {
  Declared value(Kind::any);
  value.parts = std::move(parts);
  return value;
}

bool Declared::needs_keys() const {
  return std::ranges::any_of(choices, &Choice::needed) ||
         std::ranges::any_of(keys, [&](const DeclaredKey& key) {
           return key.required && choice_of(key.name) == nullptr;
         });
}

const Choice* Declared::choice_of(std::string_view key) const {
  const auto has_key = [&](const Choice& choice) {
    return std::ranges::any_of(choice.groups, [&](const auto& group) {
      return std::ranges::find(group, key) != group.end();
    });
  };
  const auto found = std::ranges::find_if(choices, has_key);
  return found == choices.end() ? nullptr : &*found;
}

}  // namespace bbsim::yaml
