// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "scenario/key_value.hpp"

#include <algorithm>

#include "scenario/keys.hpp"
#include "yaml/spelling.hpp"

namespace bbsim::scenario {
namespace {

using yaml::Declared;

std::optional<NumberKey> find(const Declared& declared, std::string_view path,
                              const std::string& standard) {
  if (declared.kind == Declared::Kind::any) {
    for (const Declared& part : declared.parts) {
      if (const auto found = find(part, path, standard)) return found;
    }
    return {};
  }
  if (path.empty()) {
    if (declared.kind != Declared::Kind::number) return {};
    return NumberKey{declared.dimension, declared.range,
                     yaml::read_quantity(standard, false, declared.dimension).value};
  }
  const std::size_t dot = path.find('.');
  const std::string_view name = path.substr(0, dot);
  const std::string_view rest = dot == std::string_view::npos ? "" : path.substr(dot + 1);
  if (declared.kind == Declared::Kind::mapping) {
    const auto key = std::ranges::find(declared.keys, name, &yaml::DeclaredKey::name);
    return key == declared.keys.end() ? std::nullopt : find(key->value, rest, key->standard);
  }
  const bool holds_any =
      declared.kind == Declared::Kind::list || declared.kind == Declared::Kind::names;
  if (!holds_any || declared.parts.empty()) return {};
  return find(declared.parts.front(), rest, "");
}

}  // namespace

std::optional<NumberKey> number_key(std::string_view path) {
  return find(declared_keys(), yaml::american(path), "");
}

}  // namespace bbsim::scenario
